// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: one batch file, as bytes (docs/file_format.md).

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "storage/record.hpp"
#include "storage/store.hpp"

namespace opponens::storage {

/// A file of a newer schema: not damage, but this program cannot read it.
class NewerSchemaError : public StorageError {
 public:
  using StorageError::StorageError;
};

/// The HDF5 bytes of a batch. ids are the records' content hashes. Equal input gives equal bytes.
std::vector<std::byte> encode_batch(std::span<const Record* const> records, std::span<const std::string> ids);

/// Roughly what a record takes in a file before compression, in bytes.
std::size_t payload_bytes(const Record& record);

/// "000012-<first 32 hex digits of the SHA-256 of the bytes>.h5"
std::string batch_file_name(std::size_t number, std::span<const std::byte> bytes);

/// The number in a batch file's name; -1 when the name is not of that form.
long batch_number(const std::string& file_name);

/// A batch file read into memory. Its bytes are compared with its name before libhdf5 parses any of them, since a
/// truncated or flipped file can crash libhdf5.
class BatchReader {
 public:
  explicit BatchReader(const std::filesystem::path& path);
  ~BatchReader();
  const std::string& file_name() const;
  std::vector<IndexEntry> entries() const;   ///< in order of writing
  Record read(const std::string& id) const;  ///< checks the content hash
  std::vector<std::string> check() const;    ///< reads everything; one sentence per damaged object

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace opponens::storage
