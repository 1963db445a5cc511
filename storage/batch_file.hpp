// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: one batch file, as bytes (docs/file_format.md).

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "storage/posix_file.hpp"
#include "storage/record.hpp"
#include "storage/store.hpp"

namespace opponens::storage {

/// The attribute "format" of a batch file.
inline constexpr const char* kBatchFormat = "opponens batch";

/// A file of a newer schema: not damage, but this program cannot read it.
class NewerSchemaError : public StorageError {
 public:
  using StorageError::StorageError;
};

/// The HDF5 bytes of a batch. ids are the records' content hashes. Equal input gives equal bytes.
std::vector<std::byte> encode_batch(std::span<const Record* const> records, std::span<const std::string> ids);

/// Writes the same form to a new file of any size, record by record; durable when finish returns.
class BatchFileWriter {
 public:
  explicit BatchFileWriter(std::filesystem::path path);
  ~BatchFileWriter();
  void add(const Record& record, const std::string& id);
  void finish();

 private:
  struct Parts;
  std::filesystem::path path_;
  std::unique_ptr<Parts> parts_;
};

/// Roughly what a record takes in a file before compression, in bytes.
std::size_t payload_bytes(const Record& record);

/// "000012-<first 32 hex digits of the SHA-256 of the bytes>.h5"
std::string batch_file_name(std::size_t number, std::span<const std::byte> bytes);
std::string batch_file_name(std::size_t number, const std::string& sha256);

/// The number in a batch file's name; -1 when the name is not of that form.
long batch_number(const std::string& file_name);

/// The hash that a batch file's name tells is that of its bytes. Throws StorageError unless it is.
void check_bytes(const ReadOnlyFile& file);

/// A batch file open for reading; holds none of its objects.
class BatchReader {
 public:
  explicit BatchReader(const std::filesystem::path& path);
  ~BatchReader();
  const std::string& file_name() const;
  std::vector<IndexEntry> entries() const;  ///< in order of position; checks the file's bytes first
  /// The object at a position (the number of its group). Checks the content hash.
  Record read(std::size_t position, const std::string& id) const;
  std::vector<std::string> check() const;  ///< reads everything; one sentence per damaged object

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace opponens::storage
