// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the index file. It is a cache, rebuilt from the batch files whenever it is absent, damaged or
// names other files than the directory holds.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "storage/store.hpp"

namespace opponens::storage {

inline constexpr const char* kIndexName = "index.json";

/// nullopt when there is no index, or one that cannot be believed (damaged, or of another schema).
std::optional<std::vector<IndexEntry>> load_index(const std::filesystem::path& directory);

/// Replaces the index. Returns false when that is not possible (full disk, read-only directory), which loses nothing.
bool save_index(const std::filesystem::path& directory, const std::vector<IndexEntry>& entries);

}  // namespace opponens::storage
