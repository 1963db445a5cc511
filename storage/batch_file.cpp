// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/batch_file.hpp"

#include <charconv>
#include <cstdio>

#include "storage/contents.hpp"
#include "storage/hdf5_wrappers.hpp"
#include "storage/sha256.hpp"

namespace opponens::storage {
namespace {

constexpr std::size_t kHashDigits = 32;

struct FieldWriter {
  const hdf5::Handle& group;
  const std::string& name;
  ArrayOffsets& arrays;
  void operator()(double value) const { hdf5::write_attribute(group, name, value); }
  void operator()(std::int64_t value) const { hdf5::write_attribute(group, name, value); }
  void operator()(const std::string& value) const { hdf5::write_attribute(group, name, value); }
  void operator()(const std::vector<std::string>& values) const { hdf5::write_dataset(group, name, values); }
  template <typename Numbers>
  void operator()(const Numbers& values) const {
    arrays.push_back(hdf5::write_dataset(group, name, values));
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

/// Returns where the values of its arrays are.
ArrayOffsets write_object(const hdf5::Handle& objects, const std::string& slot, const Record& record,
                          const std::string& id) {
  const hdf5::Handle object = hdf5::create_group(objects, slot);
  hdf5::write_attribute(object, "schema_version", std::int64_t{kSchemaVersion});
  hdf5::write_attribute(object, "id", id);
  hdf5::write_attribute(object, "kind", record.kind);
  hdf5::write_attribute(object, "name", record.name);
  write_provenance(object, record.provenance);
  const hdf5::Handle fields = hdf5::create_group(object, "fields");
  ArrayOffsets arrays;
  for (const auto& [name, field] : record.fields) std::visit(FieldWriter{fields, name, arrays}, field);
  return arrays;
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

/// The group of the objects in a new file.
hdf5::Handle begin_batch(const hdf5::Handle& file) {
  const hdf5::Handle root = hdf5::open_group(file, "/");
  hdf5::write_attribute(root, "format", std::string(kBatchFormat));
  hdf5::write_attribute(root, "schema_version", std::int64_t{kSchemaVersion});
  return hdf5::create_group(root, "objects");
}

std::string slot_name(std::size_t slot) {
  char text[24];
  std::snprintf(text, sizeof text, "%06zu", slot);
  return text;
}

}  // namespace

std::vector<std::byte> encode_batch(std::span<const Record* const> records, std::span<const std::string> ids) {
  std::vector<std::byte> bytes;
  ContentsBuilder contents;
  {
    const auto lock = hdf5::lock_library();
    const hdf5::Handle file = hdf5::create_in_memory();
    {
      const hdf5::Handle objects = begin_batch(file);
      for (std::size_t i = 0; i < records.size(); ++i) {
        contents.add(*records[i], ids[i], write_object(objects, slot_name(i), *records[i], ids[i]));
      }
    }
    bytes = hdf5::image(file);
  }
  const std::vector<std::byte> rest = contents.finish(bytes.size());
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

struct BatchFileWriter::Parts {
  hdf5::Handle file;
  hdf5::Handle objects;
  ContentsBuilder contents{};
  std::size_t count = 0;
};

BatchFileWriter::BatchFileWriter(std::filesystem::path path) : path_(std::move(path)) {
  const auto lock = hdf5::lock_library();
  hdf5::Handle file = hdf5::create_on_disk(path_.string());
  hdf5::Handle objects = begin_batch(file);
  parts_ = std::make_unique<Parts>(Parts{std::move(file), std::move(objects)});
}

BatchFileWriter::~BatchFileWriter() {
  const auto lock = hdf5::lock_library();
  parts_.reset();
}

void BatchFileWriter::add(const Record& record, const std::string& id) {
  const auto lock = hdf5::lock_library();
  parts_->contents.add(record, id, write_object(parts_->objects, slot_name(parts_->count++), record, id));
}

void BatchFileWriter::finish() {
  ContentsBuilder contents = std::move(parts_->contents);
  {
    const auto lock = hdf5::lock_library();
    hdf5::flush(parts_->file);
    parts_->objects.finish();
    parts_->file.finish();
    parts_.reset();
  }
  const auto state = file_state(path_);
  if (!state) throw_errno("cannot read what was written", path_);
  const std::vector<std::byte> rest = contents.finish(state->size);
  append_bytes(path_, {reinterpret_cast<const char*>(rest.data()), rest.size()});
  sync_file(path_);
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
  return batch_file_name(number, hash.hex());
}

std::string batch_file_name(std::size_t number, const std::string& sha256) {
  return slot_name(number) + "-" + sha256.substr(0, kHashDigits) + ".h5";
}

long batch_number(const std::string& file_name) {
  const std::size_t dash = file_name.find('-');
  if (dash == std::string::npos || dash < 6 || file_name.size() != dash + 1 + kHashDigits + 3) return -1;
  if (!file_name.ends_with(".h5")) return -1;
  const std::string digits = file_name.substr(dash + 1, kHashDigits);
  if (digits.find_first_not_of("0123456789abcdef") != std::string::npos) return -1;
  long number = -1;
  const auto [end, error] = std::from_chars(file_name.data(), file_name.data() + dash, number);
  constexpr long kLimit = 1L << 62U;  // the next number always exists
  return error == std::errc{} && end == file_name.data() + dash && number >= 0 && number < kLimit ? number : -1;
}

}  // namespace opponens::storage
