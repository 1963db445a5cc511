// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the files that make a store's directory.

#include <filesystem>
#include <string>
#include <vector>

namespace opponens::storage {

/// What a writer's files are called until they are complete.
inline constexpr const char* kTemporaryPrefix = ".tmp-";

/// Batch files in order of commit: by number, then by name (two writers without a lock may take the same number).
std::vector<std::string> batch_files(const std::vector<std::string>& names);
std::vector<std::string> batch_files(const std::filesystem::path& directory);

void create_store(const std::filesystem::path& directory);

/// Returns its batch files. Throws InputError unless the directory is a store.
std::vector<std::string> require_store(const std::filesystem::path& directory);

/// What a writer left that died between creating and renaming. Only to be called under the lock.
void remove_leftovers(const std::filesystem::path& directory, const std::vector<std::string>& names);

}  // namespace opponens::storage
