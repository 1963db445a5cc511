// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "storage/contents.hpp"
#include "storage/store.hpp"
#include "tests/fuzz/scratch.hpp"

using namespace opponens::storage;
using opponens::fuzz::spill;

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

}  // namespace

/// The bytes as a file; and as the one object of a file whose table and trailer fit, which hardly any input has.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  read_all(spill("contents", bytes));
  const std::vector<std::byte> empty = ContentsBuilder().finish(0);
  const std::string trailer(reinterpret_cast<const char*>(empty.data()) + empty.size() - kTrailer, kTrailer);
  const auto number = [&](std::uint64_t value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  number(0);
  number(size);
  number(1);
  number(size);
  read_all(spill("contents", bytes + trailer.substr(16)));
  return 0;
}
