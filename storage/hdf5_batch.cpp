// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/hdf5_batch.hpp"

#include <algorithm>

#include "storage/batch_file.hpp"
#include "storage/hdf5_wrappers.hpp"

namespace opponens::storage {
namespace {

std::vector<std::string> string_list(const hdf5::Handle& group, const std::string& name) {
  Field field = hdf5::read_dataset(group, name);
  auto* values = std::get_if<std::vector<std::string>>(&field);
  if (values == nullptr) throw StorageError("provenance/" + name + ": not a list of strings");
  return std::move(*values);
}

Provenance read_provenance(const hdf5::Handle& object) {
  const hdf5::Handle group = hdf5::open_group(object, "provenance");
  Provenance provenance;
  provenance.command = hdf5::read_string(group, "command");
  provenance.parameters = hdf5::read_string(group, "parameters");
  provenance.seed = hdf5::read_unsigned(group, "seed");
  provenance.program_version = hdf5::read_string(group, "program_version");
  provenance.inputs = string_list(group, "inputs");
  const std::vector<std::string> files = string_list(group, "files");
  const std::vector<std::string> hashes = string_list(group, "files_sha256");
  if (files.size() != hashes.size()) throw StorageError("provenance: files and files_sha256 differ in length");
  for (std::size_t i = 0; i < files.size(); ++i) provenance.files.emplace(files[i], hashes[i]);
  return provenance;
}

/// Throws when what is stored at place is of a schema this program does not know.
void check_schema(const hdf5::Handle& object, const std::string& place) {
  const std::int64_t version = hdf5::read_integer(object, "schema_version");
  if (version > kSchemaVersion) {
    throw NewerSchemaError(place + ": written with schema version " + std::to_string(version) +
                           ", but this program knows versions up to " + std::to_string(kSchemaVersion) +
                           "; use a newer opponens to read it");
  }
  if (version < 1) throw StorageError(place + ": schema_version is " + std::to_string(version) + ", expected >= 1");
}

Record read_object(const hdf5::Handle& object) {
  Record record;
  record.kind = hdf5::read_string(object, "kind");
  record.name = hdf5::read_string(object, "name");
  record.provenance = read_provenance(object);
  const hdf5::Handle fields = hdf5::open_group(object, "fields");
  for (const auto& name : hdf5::attributes(fields)) record.fields.emplace(name, hdf5::read_attribute(fields, name));
  for (const auto& name : hdf5::links(fields)) record.fields.emplace(name, hdf5::read_dataset(fields, name));
  return record;
}

hdf5::Handle open_in_memory(const ReadOnlyFile& file) {
  std::vector<std::byte> bytes(file.size());
  if (!file.read_at(0, bytes)) throw StorageError(file.path().string() + ": cut off while it was read");
  return hdf5::open_in_memory(bytes, file.path().string());
}

}  // namespace

struct Hdf5Batch::Parts {
  std::string path;
  hdf5::Handle file;
  std::vector<std::string> slots;

  std::string place(std::size_t position) const { return path + ": /objects/" + slots.at(position); }
  hdf5::Handle object(std::size_t position) const {
    if (position >= slots.size()) throw StorageError(path + ": holds no object number " + std::to_string(position));
    return hdf5::open_group(file, "/objects/" + slots[position]);
  }
};

Hdf5Batch::Hdf5Batch(const ReadOnlyFile& file) {
  const auto lock = hdf5::lock_library();
  // Not parts_ at once: its handles have to be closed under the lock when something throws.
  auto parts = std::make_unique<Parts>(Parts{file.path().string(), open_in_memory(file), {}});
  const hdf5::Handle root = hdf5::open_group(parts->file, "/");
  if (hdf5::read_string(root, "format") != kBatchFormat) throw StorageError(parts->path + ": not an opponens batch");
  check_schema(root, parts->path);
  parts->slots = hdf5::links(hdf5::open_group(root, "objects"));
  // Slots have at least six digits; a longer number is a later one.
  std::stable_sort(parts->slots.begin(), parts->slots.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (std::size_t i = 0; i < parts->slots.size(); ++i) check_schema(parts->object(i), parts->place(i));
  parts_ = std::move(parts);
}

Hdf5Batch::~Hdf5Batch() {
  const auto lock = hdf5::lock_library();
  parts_.reset();
}

std::size_t Hdf5Batch::size() const { return parts_->slots.size(); }

ObjectHead Hdf5Batch::head(std::size_t position) const {
  const auto lock = hdf5::lock_library();
  const hdf5::Handle object = parts_->object(position);
  const hdf5::Handle provenance = hdf5::open_group(object, "provenance");
  return {hdf5::read_string(object, "id"), hdf5::read_string(object, "kind"), hdf5::read_string(object, "name"),
          string_list(provenance, "inputs")};
}

Record Hdf5Batch::read(std::size_t position, const std::string& id) const {
  Record record;
  {
    const auto lock = hdf5::lock_library();
    record = read_object(parts_->object(position));
  }
  const std::string hash = content_hash(record);
  if (hash == id) return record;
  throw StorageError(parts_->place(position) + " (" + record.kind + " '" + record.name + "'): content hash is " + hash +
                     ", expected " + id);
}

}  // namespace opponens::storage
