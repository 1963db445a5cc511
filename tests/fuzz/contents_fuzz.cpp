// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "storage/contents.hpp"
#include "storage/store.hpp"

using namespace opponens::storage;

namespace {

constexpr std::size_t kTrailer = 16 + 18;  // count, place of the table, marker

/// Whatever is believed has the id under which it is read.
void read_object(const ContentsReader& contents, std::size_t position) {
  try {
    const std::string id = contents.head(position).id;
    if (content_hash(contents.read(position, id)) != id) std::abort();
  } catch (const StorageError&) {
    return;
  }
}

void read_all(const std::filesystem::path& path) {
  const ReadOnlyFile file(path);
  try {
    const auto contents = ContentsReader::open(file);
    for (std::size_t i = 0; contents && i < contents->size(); ++i) read_object(*contents, i);
  } catch (const StorageError&) {
    // of another schema
  }
  salvage(file);
}

/// In memory where the system has that.
std::filesystem::path scratch() {
  const std::filesystem::path memory = "/dev/shm";
  const auto folder = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
  return folder / ("contents_fuzz-" + std::to_string(::getpid()));
}

void spill(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

}  // namespace

/// The bytes as a file; and as the one object of a file whose table and trailer fit, which hardly any input has.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path path = scratch();
  std::string bytes(reinterpret_cast<const char*>(data), size);
  spill(path, bytes);
  read_all(path);
  const std::vector<std::byte> empty = ContentsBuilder().finish(0);
  const std::string trailer(reinterpret_cast<const char*>(empty.data()) + empty.size() - kTrailer, kTrailer);
  const auto number = [&](std::uint64_t value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  number(0);
  number(size);
  number(1);
  number(size);
  spill(path, bytes + trailer.substr(16));
  read_all(path);
  std::filesystem::remove(path);
  return 0;
}
