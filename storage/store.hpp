// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "storage/record.hpp"

namespace opponens::storage {

/// The store is damaged or of a newer schema; what() names file and dataset. Exit code 3.
class StorageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Version of the layout written by this program (docs/file_format.md). A newer one is refused with a sentence.
inline constexpr int kSchemaVersion = 1;

struct IndexEntry {
  std::string id;    ///< content hash, hex
  std::string kind;
  std::string name;
  std::string file;  ///< file name inside the store
  std::vector<std::string> inputs;
};

/// A directory of immutable HDF5 files, one per committed batch, and an index that can be rebuilt from them.
class Store {
 public:
  /// Opens an existing store, or makes one when create is set. Throws InputError when the directory cannot be used,
  /// StorageError when it is damaged or newer.
  Store(std::filesystem::path directory, bool create);

  /// Writes records as one file (several of bounded size when large): temporary file, fsync, rename, directory fsync.
  /// Returns their ids in order. A record whose id is present already is not written again. When anything fails the
  /// store is as it was.
  std::vector<std::string> commit(const std::vector<Record>& records);

  /// Reads one object and checks its content hash. id may be an unambiguous prefix.
  Record read(const std::string& id) const;

  /// Entries of a kind (all when empty), in order of commit.
  std::vector<IndexEntry> list(const std::string& kind = "") const;

  /// Reads and checks everything; returns one sentence per damaged file or object.
  std::vector<std::string> check() const;

  /// Appends one JSON line to the run log beside the objects: dates, timings, host.
  void log_run(const std::string& json_line) const;

  const std::filesystem::path& directory() const { return directory_; }

 private:
  std::filesystem::path directory_;
  std::vector<IndexEntry> index_;
};

}  // namespace opponens::storage
