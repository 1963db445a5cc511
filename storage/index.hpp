// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the index file. It is a cache, rebuilt from the batch files whenever it is absent, damaged or
// names other files than the directory holds. It is a sequence of blocks, one per batch file, that are appended
// (docs/file_format.md): opening is one read and a check of sums, without making anything per object.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "storage/store.hpp"

namespace opponens::storage {

inline constexpr const char* kIndexName = "index.bin";

/// One block, checked: a view of bytes that have to outlive it. Every access is O(1) beside the copies it makes.
class IndexBlock {
 public:
  std::string_view file() const { return text(file_); }
  std::size_t size() const { return count_; }
  std::string_view bytes() const { return bytes_; }
  std::string_view raw_id(std::size_t position) const;  ///< 32 bytes
  std::string_view kind(std::size_t position) const { return text(number(position, 0)); }
  IndexEntry entry(std::size_t position) const;

 private:
  friend struct BlockParser;
  std::uint32_t load(std::size_t offset) const;
  std::uint32_t number(std::size_t position, std::size_t which) const;  ///< kind, name, first input, count of inputs
  std::string_view text(std::uint32_t which) const;

  std::string_view bytes_;
  std::uint32_t file_ = 0;
  std::uint32_t count_ = 0;
  std::size_t entries_ = 0;  // offsets in bytes_
  std::size_t inputs_ = 0;
  std::size_t text_ends_ = 0;
  std::size_t texts_ = 0;
};

struct ParsedIndex {
  std::vector<IndexBlock> blocks;
  std::size_t valid_bytes = 0;  ///< up to the end of the last good block; what follows is not believed
};

/// The one reader of index bytes, which may be anything. Blocks are read up to the first that is not as it was written:
/// its sum differs (any change within 32 bytes is sure to be found, any other but for a chance of 2^-64) or it does
/// not hold together.
ParsedIndex parse_index(std::string_view bytes);

/// The block of one batch file. entries: in order of position; their file is not looked at. Throws StorageError when an
/// id is not 64 lower-case hex digits.
std::string encode_index_block(const std::string& file, const std::vector<IndexEntry>& entries);

/// Makes magic, size and sum of a block fit the bytes that follow them. bytes is padded to a multiple of 8.
void seal_index_block(std::string& bytes);

/// 64 lower-case hex digits of 32 bytes.
std::string id_text(std::string_view raw_id);

}  // namespace opponens::storage
