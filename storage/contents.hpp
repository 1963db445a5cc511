// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the contents of a batch file, which follow its HDF5 bytes (docs/file_format.md). They hold every
// object's canonical bytes, with the place of its arrays in the file instead of their values. So one object is read
// without libhdf5 and without the rest of the file; its content hash, which covers all that is returned, is the check.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "storage/posix_file.hpp"
#include "storage/record.hpp"

namespace opponens::storage {

/// Where the values of an object's arrays are: one offset in the file per field of rank 1 or 2, in order of name.
using ArrayOffsets = std::vector<std::uint64_t>;

/// Collects the contents while the HDF5 part is written.
class ContentsBuilder {
 public:
  void add(const Record& record, const std::string& id, const ArrayOffsets& arrays);
  /// The bytes that follow an HDF5 part of that many bytes; the object is used up.
  std::vector<std::byte> finish(std::uint64_t hdf5_bytes);

 private:
  std::vector<std::byte> parts_;
  std::vector<std::uint64_t> starts_;  // in parts_
};

/// What the contents tell of an object beside its fields.
struct ObjectHead {
  std::string id;
  std::string kind;
  std::string name;
  std::vector<std::string> inputs;
};

/// Reads objects by their position. The file has to outlive it. No byte is believed before it is checked: what does
/// not fit throws StorageError.
class ContentsReader {
 public:
  /// nullopt when the file has no contents, or a table of them that is damaged. Throws NewerSchemaError when its last
  /// byte, the schema, is a digit that this program does not know.
  static std::optional<ContentsReader> open(const ReadOnlyFile& file);

  std::size_t size() const { return starts_.size() - 1; }
  ObjectHead head(std::size_t position) const;
  /// Checks the content hash against id.
  Record read(std::size_t position, const std::string& id) const;

 private:
  ContentsReader(const ReadOnlyFile& file, std::vector<std::uint64_t> starts)
      : file_(&file), starts_(std::move(starts)) {}
  std::vector<std::byte> part(std::size_t position) const;

  const ReadOnlyFile* file_;
  std::vector<std::uint64_t> starts_;  // of each object's part, and the end of the last
};

/// The objects that are still intact in a damaged file: parts are found by their marker, wherever they are.
std::vector<Record> salvage(const ReadOnlyFile& file);

}  // namespace opponens::storage
