// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/store_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "core/require.hpp"
#include "storage/batch_file.hpp"
#include "storage/index.hpp"
#include "storage/posix_file.hpp"

namespace opponens::storage {

namespace fs = std::filesystem;

std::vector<std::string> batch_files(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  for (const auto& name : names) {
    if (batch_number(name) >= 0) files.push_back(name);
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return batch_number(a) < batch_number(b); });
  return files;
}

std::vector<std::string> batch_files(const fs::path& directory) { return batch_files(directory_entries(directory)); }

void create_store(const fs::path& directory) {
  std::error_code error;
  std::vector<fs::path> parents;  // of the folders that are made
  for (fs::path folder = fs::absolute(directory, error); !folder.empty() && !fs::exists(folder, error);) {
    folder = folder.parent_path();
    parents.push_back(folder);
  }
  fs::create_directories(directory, error);
  if (error) throw InputError(directory.string() + ": cannot make the store: " + error.message());
  if (::access(directory.c_str(), W_OK | X_OK) != 0) throw_errno("cannot write in the store", directory);
  for (const auto& parent : parents) sync_directory(parent);  // or a power cut takes the store with its first commits
}

std::vector<std::string> require_store(const fs::path& directory) {
  std::error_code error;
  const fs::file_status status = fs::status(directory, error);
  if (!fs::exists(status)) throw InputError(directory.string() + ": no such store: " + error.message());
  if (!fs::is_directory(status)) throw InputError(directory.string() + ": not a directory, so not a store");
  std::vector<std::string> files = batch_files(directory);
  if (fs::exists(directory / kIndexName) || !files.empty()) return files;
  throw InputError(directory.string() + ": not a store: it holds neither " + kIndexName + " nor any batch file");
}

void remove_leftovers(const fs::path& directory, const std::vector<std::string>& names) {
  for (const auto& name : names) {
    std::error_code ignored;
    if (name.starts_with(kTemporaryPrefix)) fs::remove(directory / name, ignored);
  }
}

}  // namespace opponens::storage
