// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: what a store holds, as one process knows it, and the index file that keeps it.

#include <cstdint>
#include <filesystem>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "storage/index.hpp"
#include "storage/posix_file.hpp"

namespace opponens::storage {

class Catalog {
 public:
  struct Place {
    std::uint32_t block = 0;
    std::uint32_t position = 0;  ///< in the batch file
    auto operator<=>(const Place&) const = default;
  };
  struct Gone {
    std::string file;
    std::vector<IndexEntry> entries;
  };
  struct Changes {
    std::vector<std::string> unknown;  ///< files that the index does not name, in order
    std::vector<Gone> gone;            ///< files that it names and that are not there
  };

  /// Reads the index file unless it is the one that this object read or wrote last. Without the lock, before the
  /// directory is listed: a file that the index names is then there, whatever writers do meanwhile.
  void load(const std::filesystem::path& directory);

  /// Adds what a batch file holds, in order of position. Throws StorageError when the ids are none.
  void append(const std::string& file, const std::vector<IndexEntry>& entries);

  /// Puts the files in the given order (that of commit) and drops what is not among them.
  Changes arrange(const std::vector<std::string>& files);

  /// Brings the index file up to date: appends to it, or replaces it. To be called under the lock. Returns false when
  /// another process has written it since load, or when it is not possible (full disk, read-only directory); both
  /// lose nothing.
  bool save(const std::filesystem::path& directory);

  bool is_saved() const { return saved_ == blocks_.size(); }

  /// Objects of a kind (all when empty) in order of commit; one that is in two files counts once, as the earlier.
  std::vector<IndexEntry> list(const std::string& kind) const;
  /// The first two objects whose ids begin with prefix.
  std::vector<Place> find(const std::string& prefix) const;
  /// Every place of the object that is at one, in order of commit.
  std::vector<Place> copies(Place place) const;
  bool contains(const std::string& id) const { return !find(id).empty(); }
  IndexEntry entry(Place place) const { return blocks_[place.block].entry(place.position); }
  /// What a file holds; nullopt when it is not known.
  std::optional<std::vector<IndexEntry>> entries(const std::string& file) const;
  /// Of the last object; empty when there is none.
  std::string last_id() const;

 private:
  struct Key {
    std::uint64_t begin;  ///< of the id: orders nearly all without looking at it
    Place place;
  };
  std::string_view raw_id(Place place) const { return blocks_[place.block].raw_id(place.position); }
  bool before(const Key& a, const Key& b) const;
  const std::vector<Key>& keys() const;

  std::list<std::string> bytes_;      // what the blocks view
  std::vector<IndexBlock> blocks_;    // in order of commit
  std::optional<std::size_t> saved_;  // how many of them the index file holds; none: it has to be replaced
  std::optional<FileState> state_;    // of the index file as last read or written
  mutable std::vector<Key> keys_;     // sorted by id, then place; made when first asked for
  mutable std::size_t keyed_ = 0;     // blocks that are in keys_
};

}  // namespace opponens::storage
