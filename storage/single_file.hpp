// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "storage/store.hpp"

namespace opponens::storage {

/// The objects and everything in the store that they were made from, in the order in which they were made last.
struct Closure {
  std::vector<IndexEntry> objects;
  std::vector<std::string> missing;  ///< ids of inputs that the store does not hold
};
/// Throws InputError for an unknown or ambiguous id.
Closure closure_of(const Store& store, const std::vector<std::string>& ids);

/// Called between objects with how many are done and how many there are; may throw to end it.
using Step = std::function<void(std::size_t, std::size_t)>;

/// Writes objects to one HDF5 file in the form of a batch file (docs/file_format.md), which import_single_file takes
/// back. One object at a time is in memory. An existing file is replaced when the new one is complete.
void export_single_file(const Store& store, const std::vector<IndexEntry>& objects, const std::filesystem::path& out,
                        const Step& step);

/// Whether a file is of that form (and not cut off).
bool is_single_file(const std::filesystem::path& file);

/// Copies the objects of such a file into the store, in commits of a few MB; every content hash is checked and kept.
/// Returns the ids of all, also of those that were there. The file is read by our own code, never by libhdf5, so it
/// may come from anybody. Throws StorageError when an object is damaged; what was committed before stays.
std::vector<std::string> import_single_file(const std::filesystem::path& file, Store& store, const Step& step);

/// Copies what target does not hold from another store, in the order in which it was made last there. Returns the ids
/// copied. Doing it again copies nothing.
std::vector<std::string> merge_store(const Store& from, Store& target, const Step& step);

}  // namespace opponens::storage
