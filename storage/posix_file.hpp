// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the file-system calls of the store, each checked. Failures throw InputError with path and the
// system's words.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opponens::storage {

[[noreturn]] void throw_errno(const std::string& what, const std::filesystem::path& path);

std::string read_file(const std::filesystem::path& path);

/// A file open for reading at any place; several threads may read at once. Its size is that of opening.
class ReadOnlyFile {
 public:
  explicit ReadOnlyFile(std::filesystem::path path);
  ~ReadOnlyFile();
  ReadOnlyFile(const ReadOnlyFile&) = delete;
  ReadOnlyFile& operator=(const ReadOnlyFile&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Fills bytes from offset; false when the file ends before.
  bool read_at(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// Which file a name stands for just now, and how long it is.
struct FileState {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size = 0;
  std::int64_t changed_ns = 0;  ///< time of its last change, within the second
  bool operator==(const FileState&) const = default;
};
std::optional<FileState> file_state(const std::filesystem::path& path);

/// Creates path (it must not exist) and writes all bytes; durable: waits until the disk has them.
enum class Durable { no, yes };
void write_new_file(const std::filesystem::path& path, std::span<const std::byte> bytes, Durable durable);

/// Renames inside one file system, replacing what is there.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Waits until the disk has a file.
void sync_file(const std::filesystem::path& path);

/// Makes renames and removals inside directory durable.
void sync_directory(const std::filesystem::path& directory);

/// Appends bytes to a file that is there; cuts it back and throws when they do not fit.
void append_bytes(const std::filesystem::path& path, std::string_view bytes);

/// Appends text with one write(2) in append mode, so that lines of concurrent writers do not mix. A last
/// line that was cut off is ended first, so that it does not swallow this one.
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

/// A file that is written under another name until it is complete; removed when it never is. What a killed process of
/// the same number left there goes first.
class Draft {
 public:
  explicit Draft(std::filesystem::path final_path);
  ~Draft() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void complete() const;  ///< durable when what was written is

 private:
  std::filesystem::path final_;
  std::filesystem::path path_;
};

}  // namespace opponens::storage
