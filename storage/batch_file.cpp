// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/batch_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>

#include "storage/hdf5_wrappers.hpp"
#include "storage/posix_file.hpp"
#include "storage/sha256.hpp"

namespace opponens::storage {
namespace {

constexpr std::size_t kHashDigits = 32;
constexpr const char* kFormat = "opponens batch";

struct FieldWriter {
  const hdf5::Handle& group;
  const std::string& name;
  void operator()(double value) const { hdf5::write_attribute(group, name, value); }
  void operator()(std::int64_t value) const { hdf5::write_attribute(group, name, value); }
  void operator()(const std::string& value) const { hdf5::write_attribute(group, name, value); }
  template <typename Array>
  void operator()(const Array& values) const {
    hdf5::write_dataset(group, name, values);
  }
};

void write_provenance(const hdf5::Handle& object, const Provenance& provenance) {
  const hdf5::Handle group = hdf5::create_group(object, "provenance");
  hdf5::write_attribute(group, "command", provenance.command);
  hdf5::write_attribute(group, "parameters", provenance.parameters);
  hdf5::write_attribute(group, "seed", provenance.seed);
  hdf5::write_attribute(group, "program_version", provenance.program_version);
  std::vector<std::string> files;
  std::vector<std::string> hashes;
  for (const auto& [file, hash] : provenance.files) {
    files.push_back(file);
    hashes.push_back(hash);
  }
  hdf5::write_dataset(group, "inputs", provenance.inputs);
  hdf5::write_dataset(group, "files", files);
  hdf5::write_dataset(group, "files_sha256", hashes);
}

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

void write_object(const hdf5::Handle& objects, const std::string& slot, const Record& record, const std::string& id) {
  const hdf5::Handle object = hdf5::create_group(objects, slot);
  hdf5::write_attribute(object, "schema_version", std::int64_t{kSchemaVersion});
  hdf5::write_attribute(object, "id", id);
  hdf5::write_attribute(object, "kind", record.kind);
  hdf5::write_attribute(object, "name", record.name);
  write_provenance(object, record.provenance);
  const hdf5::Handle fields = hdf5::create_group(object, "fields");
  for (const auto& [name, field] : record.fields) std::visit(FieldWriter{fields, name}, field);
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

struct PayloadSize {
  std::size_t operator()(double) const { return 8; }
  std::size_t operator()(std::int64_t) const { return 8; }
  std::size_t operator()(const std::string& value) const { return value.size(); }
  std::size_t operator()(const std::vector<std::string>& values) const {
    std::size_t size = 0;
    for (const auto& value : values) size += value.size() + 16;
    return size;
  }
  std::size_t operator()(const Eigen::VectorXd& values) const { return 8 * static_cast<std::size_t>(values.size()); }
  std::size_t operator()(const Eigen::MatrixXd& values) const { return 8 * static_cast<std::size_t>(values.size()); }
};

std::string slot_name(std::size_t slot) {
  char text[24];
  std::snprintf(text, sizeof text, "%06zu", slot);
  return text;
}

}  // namespace

std::vector<std::byte> encode_batch(std::span<const Record* const> records, std::span<const std::string> ids) {
  const hdf5::Handle file = hdf5::create_in_memory();
  {
    const hdf5::Handle root = hdf5::open_group(file, "/");
    hdf5::write_attribute(root, "format", std::string(kFormat));
    hdf5::write_attribute(root, "schema_version", std::int64_t{kSchemaVersion});
    const hdf5::Handle objects = hdf5::create_group(root, "objects");
    for (std::size_t i = 0; i < records.size(); ++i) write_object(objects, slot_name(i), *records[i], ids[i]);
  }
  return hdf5::image(file);
}

std::size_t payload_bytes(const Record& record) {
  constexpr std::size_t kGroupsAndHeaders = 4096;
  std::size_t size = kGroupsAndHeaders + record.provenance.parameters.size();
  size += 80 * record.provenance.inputs.size() + 160 * record.provenance.files.size();
  for (const auto& [name, field] : record.fields) size += name.size() + 128 + std::visit(PayloadSize{}, field);
  return size;
}

std::string batch_file_name(std::size_t number, std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return slot_name(number) + "-" + hash.hex().substr(0, kHashDigits) + ".h5";
}

long batch_number(const std::string& file_name) {
  const std::size_t dash = file_name.find('-');
  if (dash == std::string::npos || dash < 6 || file_name.size() != dash + 1 + kHashDigits + 3) return -1;
  if (!file_name.ends_with(".h5")) return -1;
  const std::string digits = file_name.substr(dash + 1, kHashDigits);
  if (digits.find_first_not_of("0123456789abcdef") != std::string::npos) return -1;
  long number = -1;
  const auto [end, error] = std::from_chars(file_name.data(), file_name.data() + dash, number);
  return error == std::errc{} && end == file_name.data() + dash && number >= 0 ? number : -1;
}

struct BatchReader::Parts {
  std::string name;
  hdf5::Handle file;
  std::vector<std::string> slots;
  std::map<std::string, std::string> slot_of;  // id -> slot

  hdf5::Handle object(const std::string& slot) const { return hdf5::open_group(file, "/objects/" + slot); }
};

namespace {

hdf5::Handle open_verified(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const std::string name = path.filename().string();
  if (batch_file_name(static_cast<std::size_t>(batch_number(name)), std::as_bytes(std::span(bytes))) != name) {
    throw StorageError(path.string() + ": its bytes do not match the hash in its name (truncated or damaged, " +
                       std::to_string(bytes.size()) + " bytes)");
  }
  return hdf5::open_in_memory(std::as_bytes(std::span(bytes)), path.string());
}

}  // namespace

BatchReader::BatchReader(const std::filesystem::path& path)
    : parts_(new Parts{path.filename().string(), open_verified(path), {}, {}}) {
  const hdf5::Handle root = hdf5::open_group(parts_->file, "/");
  if (hdf5::read_string(root, "format") != kFormat) throw StorageError(path.string() + ": not an opponens batch");
  check_schema(root, path.string());
  parts_->slots = hdf5::links(hdf5::open_group(root, "objects"));
  // Slots have at least six digits; a longer number is a later one.
  std::stable_sort(parts_->slots.begin(), parts_->slots.end(),
                   [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (const auto& slot : parts_->slots) {
    const hdf5::Handle object = parts_->object(slot);
    check_schema(object, path.string() + ": /objects/" + slot);
    parts_->slot_of.emplace(hdf5::read_string(object, "id"), slot);
  }
}

BatchReader::~BatchReader() = default;

const std::string& BatchReader::file_name() const { return parts_->name; }

std::vector<IndexEntry> BatchReader::entries() const {
  std::vector<IndexEntry> entries;
  for (const auto& slot : parts_->slots) {
    const hdf5::Handle object = parts_->object(slot);
    const hdf5::Handle provenance = hdf5::open_group(object, "provenance");
    entries.push_back({hdf5::read_string(object, "id"), hdf5::read_string(object, "kind"),
                       hdf5::read_string(object, "name"), parts_->name, string_list(provenance, "inputs")});
  }
  return entries;
}

Record BatchReader::read(const std::string& id) const {
  const auto found = parts_->slot_of.find(id);
  if (found == parts_->slot_of.end()) throw StorageError(parts_->name + ": holds no object " + id);
  Record record = read_object(parts_->object(found->second));
  const std::string hash = content_hash(record);
  if (hash != id) {
    throw StorageError(parts_->name + ": /objects/" + found->second + " (" + record.kind + " '" + record.name +
                       "'): content hash is " + hash + ", expected " + id);
  }
  return record;
}

std::vector<std::string> BatchReader::check() const {
  std::vector<std::string> sentences;
  for (const auto& [id, slot] : parts_->slot_of) {
    try {
      read(id);
    } catch (const StorageError& error) {
      sentences.emplace_back(error.what());
    }
  }
  return sentences;
}

}  // namespace opponens::storage
