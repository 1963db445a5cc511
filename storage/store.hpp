// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
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
  std::string id;  ///< content hash, hex
  std::string kind;
  std::string name;
  std::string file;  ///< file name inside the store
  std::vector<std::string> inputs;
};

class BatchReader;

/// A directory of immutable HDF5 files, one per committed batch, and an index that can be rebuilt from them.
/// Several processes may read and commit at once. One Store object belongs to one thread (libhdf5 is not thread safe).
class Store {
 public:
  /// Opens an existing store, or makes one when create is set. Throws InputError when the directory cannot be used,
  /// StorageError when a file in it is of a newer schema. A damaged file does not keep the store from opening, so that
  /// check() can name all of them and what is intact can be read; list() and commit() then throw StorageError.
  Store(std::filesystem::path directory, bool create);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  /// Writes records as one file (several of bounded size when large): temporary file, fsync, rename, directory fsync.
  /// Returns their ids in order. A record whose id is present already is not written again; a line of the run log then
  /// says that it was made again. When anything fails the
  /// store is as it was. Throws std::invalid_argument for a record that cannot be stored (see check_storable),
  /// InputError when the disk is full or the directory cannot be written.
  std::vector<std::string> commit(const std::vector<Record>& records);

  /// Reads one object and checks its content hash. id may be an unambiguous prefix. Throws InputError for an unknown or
  /// ambiguous id. The last file read is kept in memory (tens of MB at most), so reading in order of commit is cheap.
  Record read(const std::string& id) const;

  /// Entries of a kind (all when empty), in order of commit, as of opening or this object's last commit.
  std::vector<IndexEntry> list(const std::string& kind = "") const;

  /// The same in the order in which they were made last: what a later commit made again, byte for byte, is not written
  /// again but counts as that commit's. Follows the run log; where that is missing or cut off, the order of commit.
  std::vector<IndexEntry> list_as_produced(const std::string& kind = "") const;

  /// Reads and checks everything; returns one sentence per damaged file or object.
  std::vector<std::string> check() const;

  /// Appends one JSON line to the run log beside the objects: dates, timings, host.
  void log_run(const std::string& json_line) const;

  const std::filesystem::path& directory() const { return directory_; }

 private:
  void refresh();
  void adopt(std::vector<IndexEntry> entries);
  void require_undamaged() const;
  void write_batches(const std::vector<Record>& records, const std::vector<std::string>& ids,
                     const std::vector<std::size_t>& fresh);
  const IndexEntry& find(const std::string& id) const;
  const BatchReader& reader(const std::string& file) const;

  std::filesystem::path directory_;
  std::vector<IndexEntry> index_;              // order of commit
  std::map<std::string, std::size_t> by_id_;   // id -> position in index_
  std::vector<std::string> missing_;           // sentences, one per file that the index names and that is gone
  std::vector<std::string> unreadable_;        // sentences, one per file that cannot be read
  mutable std::unique_ptr<BatchReader> last_;  // the file read last
};

}  // namespace opponens::storage
