// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "storage/store.hpp"

namespace opponens::storage {

/// Folder inside a store for files that are damaged.
inline constexpr const char* kDamagedFolder = "damaged";

/// A batch file that is damaged or gone.
struct DamagedFile {
  std::string file;
  std::string reason;             ///< the first sentence about it
  std::vector<IndexEntry> saved;  ///< objects still intact (rewritten unless the run was dry)
  std::vector<IndexEntry> lost;   ///< objects that the index knows to have been in it and that no other file holds
  bool index_knew_it = false;     ///< when not, more objects than those in lost may be gone
  bool unreadable = false;        ///< the system does not let us read it: neither judged nor set aside
};

struct Dangling {
  IndexEntry object;
  std::string missing_input;  ///< an id that the store does not hold (afterwards)
};

struct RepairReport {
  std::vector<DamagedFile> files;
  std::vector<Dangling> dangling;
};

/// Reads and checks everything. A damaged file gets a name in damaged/, its intact objects are written to a new file of
/// the same number, so that the order of commit stays, and then its first name goes; no byte is deleted, and a kill in
/// between is made up for by the next run. Holds the writers' lock. dry_run: only looks. Throws NewerSchemaError (exit
/// 3) for files of a newer schema.
RepairReport repair(const std::filesystem::path& directory, bool dry_run);

}  // namespace opponens::storage
