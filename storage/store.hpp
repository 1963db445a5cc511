// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
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

/// A directory of immutable HDF5 files, one per committed batch, and an index that can be rebuilt from them.
/// Several processes may read and commit at once. One Store object belongs to one thread; several threads have one
/// each, and read side by side (libhdf5, which is not thread safe, only writes, and reads files of other makers, under
/// a lock).
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
  /// Returns their ids in order. A record whose id is present already is read, to be sure of it (see require_intact),
  /// and not written again; a line of the run log then says that it was made again. When anything fails the store is as
  /// it was. Throws std::invalid_argument for a record that cannot be stored (see check_storable), InputError when the
  /// disk is full or the directory cannot be written.
  std::vector<std::string> commit(const std::vector<Record>& records);

  /// Reads one object and checks its content hash. id may be an unambiguous prefix. Throws InputError for an unknown or
  /// ambiguous id. Only the object's own bytes are read. The file read last stays open, so reading in order of commit
  /// is cheapest: one pass over the disk, about the speed of SHA-256, and one object in memory. Where several files
  /// hold the object, the first intact copy is taken.
  Record read(const std::string& id) const;

  /// Throws StorageError, which asks for a repair, unless the object can be read: before it counts as stored already.
  void require_intact(const std::string& id) const;

  /// What the index tells of one object, found as above; nothing of it is read.
  IndexEntry find(const std::string& id) const;

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
  struct State;
  std::filesystem::path directory_;
  std::unique_ptr<State> state_;
};

}  // namespace opponens::storage
