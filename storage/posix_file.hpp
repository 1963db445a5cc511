// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the file-system calls of the store, each checked. Failures throw InputError with path and the
// system's words.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opponens::storage {

[[noreturn]] void throw_errno(const std::string& what, const std::filesystem::path& path);

std::string read_file(const std::filesystem::path& path);

/// Creates path (it must not exist) and writes all bytes; durable: waits until the disk has them.
enum class Durable { no, yes };
void write_new_file(const std::filesystem::path& path, std::span<const std::byte> bytes, Durable durable);

/// Makes renames and removals inside directory durable.
void sync_directory(const std::filesystem::path& directory);

/// Appends text with one write(2) in append mode, so that lines of concurrent writers do not mix.
void append_line(const std::filesystem::path& path, std::string_view text);

/// Names of the directory's entries, sorted by their bytes.
std::vector<std::string> directory_entries(const std::filesystem::path& directory);

/// An advisory lock on a directory (flock), freed by the system when its holder dies.
class DirectoryLock {
 public:
  enum class Wait { no, yes };
  DirectoryLock(const std::filesystem::path& directory, Wait wait);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;
  bool held() const { return held_; }  ///< false: busy and not waited for, or the file system knows no locks

 private:
  int descriptor_;
  bool held_ = false;
};

}  // namespace opponens::storage
