// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "storage/batch_file.hpp"
#include "storage/contents.hpp"
#include "storage/hdf5_batch.hpp"
#include "storage/sha256.hpp"

namespace opponens::storage {

void check_bytes(const ReadOnlyFile& file) {
  constexpr std::uint64_t kPiece = 1U << 20U;
  Sha256 hash;
  std::vector<std::byte> bytes(static_cast<std::size_t>(std::min(kPiece, file.size())));
  for (std::uint64_t at = 0; at < file.size(); at += kPiece) {
    const auto piece = std::span(bytes).first(static_cast<std::size_t>(std::min(kPiece, file.size() - at)));
    if (!file.read_at(at, piece)) break;  // cut off meanwhile: the hash differs
    hash.update(piece);
  }
  const std::string name = file.path().filename().string();
  const auto number = static_cast<std::size_t>(batch_number(name));
  if (batch_file_name(number, hash.hex()) == name) return;
  throw StorageError(file.path().string() + ": its bytes do not match the hash in its name (truncated or damaged, " +
                     std::to_string(file.size()) + " bytes)");
}

namespace {

/// Of a damaged file the schema cannot be believed.
std::optional<ContentsReader> open_contents(const ReadOnlyFile& file) {
  try {
    return ContentsReader::open(file);
  } catch (const NewerSchemaError&) {
    check_bytes(file);
    throw;
  }
}

}  // namespace

struct BatchReader::Parts {
  ReadOnlyFile file;
  std::string name;
  std::optional<ContentsReader> contents;
  std::optional<Hdf5Batch> hdf5;  // when there are no contents

  explicit Parts(const std::filesystem::path& path)
      : file(path), name(path.filename().string()), contents(open_contents(file)) {
    if (contents) return;
    check_bytes(file);
    hdf5.emplace(file);
  }
  std::size_t size() const { return contents ? contents->size() : hdf5->size(); }
  ObjectHead head(std::size_t position) const { return contents ? contents->head(position) : hdf5->head(position); }
};

BatchReader::BatchReader(const std::filesystem::path& path) : parts_(std::make_unique<Parts>(path)) {}

BatchReader::~BatchReader() = default;

const std::string& BatchReader::file_name() const { return parts_->name; }

std::vector<IndexEntry> BatchReader::entries() const {
  if (parts_->contents) check_bytes(parts_->file);
  std::vector<IndexEntry> entries;
  for (std::size_t i = 0; i < parts_->size(); ++i) {
    ObjectHead head = parts_->head(i);
    entries.push_back(
        {std::move(head.id), std::move(head.kind), std::move(head.name), parts_->name, std::move(head.inputs)});
  }
  return entries;
}

Record BatchReader::read(std::size_t position, const std::string& id) const {
  return parts_->contents ? parts_->contents->read(position, id) : parts_->hdf5->read(position, id);
}

std::vector<std::string> BatchReader::check() const {
  std::vector<std::string> sentences;
  if (parts_->contents) check_bytes(parts_->file);
  for (std::size_t i = 0; i < parts_->size(); ++i) {
    try {
      read(i, parts_->head(i).id);
    } catch (const StorageError& error) {
      sentences.emplace_back(error.what());
    }
  }
  return sentences;
}

}  // namespace opponens::storage
