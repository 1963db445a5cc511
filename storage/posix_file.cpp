// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/posix_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "core/require.hpp"

namespace opponens::storage {
namespace {

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags, const char* what) : path_(path) {
    do {
      value_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    } while (value_ < 0 && errno == EINTR);
    if (value_ < 0) throw_errno(what, path);
  }
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

  /// close can report a late write error (NFS, quotas).
  void close() {
    const int status = ::close(std::exchange(value_, -1));
    if (status != 0) throw_errno("cannot finish writing", path_);
  }

 private:
  std::filesystem::path path_;
  int value_ = -1;
};

void write_all(const Descriptor& file, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file.value(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_errno("cannot write", path);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void sync(const Descriptor& file, const std::filesystem::path& path) {
  if (::fsync(file.value()) != 0) throw_errno("cannot flush to disk", path);
}

}  // namespace

void throw_errno(const std::string& what, const std::filesystem::path& path) {
  throw InputError(path.string() + ": " + what + ": " + std::generic_category().message(errno));
}

std::string read_file(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY, "cannot open");
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) throw_errno("cannot read", path);
  if (S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    throw_errno("cannot read", path);
  }
  // One byte more, so that the end is seen without another buffer.
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)) + 1, '\0');
  std::size_t filled = 0;
  while (true) {
    if (filled == bytes.size()) bytes.resize(bytes.size() + 4096);  // the size may be unknown (pipes) or growing
    const ssize_t count = ::read(file.value(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_errno("cannot read", path);
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  return bytes;
}

ReadOnlyFile::ReadOnlyFile(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (descriptor_ < 0) throw_errno("cannot open", path_);
  if (::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::uint64_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  throw InputError(path_.string() + ": cannot read: not a regular file");
}

ReadOnlyFile::~ReadOnlyFile() { ::close(descriptor_); }

bool ReadOnlyFile::read_at(std::uint64_t offset, std::span<std::byte> bytes) const {
  if (offset > size_ || bytes.size() > size_ - offset) return false;
  while (!bytes.empty()) {
    const ssize_t count = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_errno("cannot read", path_);
    if (count == 0) return false;  // cut off meanwhile
    offset += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

std::optional<FileState> file_state(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileState{status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size), status.st_mtim.tv_nsec};
}

void write_new_file(const std::filesystem::path& path, std::span<const std::byte> bytes, Durable durable) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL, "cannot create");
  write_all(file, bytes, path);
  if (durable == Durable::yes) sync(file, path);
  file.close();
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) throw_errno("cannot rename into place", to);
}

void sync_file(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY, "cannot open");
  sync(file, path);
}

void sync_directory(const std::filesystem::path& directory) {
  const Descriptor file(directory, O_RDONLY | O_DIRECTORY, "cannot open");
  sync(file, directory);
}

void append_bytes(const std::filesystem::path& path, std::string_view bytes) {
  Descriptor file(path, O_WRONLY | O_APPEND, "cannot open");
  struct stat before {};
  if (::fstat(file.value(), &before) != 0) throw_errno("cannot append", path);
  try {
    write_all(file, std::as_bytes(std::span(bytes)), path);
    file.close();
  } catch (const InputError&) {
    if (::truncate(path.c_str(), before.st_size) != 0) throw_errno("cannot cut back", path);
    throw;
  }
}

void append_line(const std::filesystem::path& path, std::string_view text) {
  Descriptor file(path, O_RDWR | O_CREAT | O_APPEND, "cannot open");
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) throw_errno("cannot append", path);
  char last = '\n';
  if (status.st_size > 0 && ::pread(file.value(), &last, 1, status.st_size - 1) < 0) throw_errno("cannot read", path);
  std::string line(last == '\n' ? 0 : 1, '\n');
  line += text;
  write_all(file, std::as_bytes(std::span(line)), path);
  file.close();
}

std::vector<std::string> directory_entries(const std::filesystem::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(directory, error);
  const std::filesystem::directory_iterator end;
  while (!error && entry != end) {
    names.push_back(entry->path().filename().string());
    entry.increment(error);
  }
  if (error) throw InputError(directory.string() + ": cannot list the directory: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

DirectoryLock::DirectoryLock(const std::filesystem::path& directory, Wait wait)
    : descriptor_(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw_errno("cannot open the directory", directory);
  int status = 0;
  do {
    status = ::flock(descriptor_, LOCK_EX | (wait == Wait::yes ? 0 : LOCK_NB));
  } while (status != 0 && errno == EINTR);
  held_ = status == 0;
}

DirectoryLock::~DirectoryLock() { ::close(descriptor_); }

Draft::Draft(std::filesystem::path final_path)
    : final_(std::move(final_path)), path_(final_.string() + ".tmp-" + std::to_string(::getpid())) {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void Draft::complete() const {
  rename_file(path_, final_);
  sync_directory(final_.has_parent_path() ? final_.parent_path() : ".");
}

}  // namespace opponens::storage
