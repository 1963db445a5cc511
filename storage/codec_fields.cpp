// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/codec_fields.hpp"

#include <algorithm>
#include <limits>

#include "storage/store.hpp"

namespace opponens::storage {

FieldReader::FieldReader(const Record& record, const std::string& expected_kind) : record_(record) {
  if (record.kind != expected_kind) {
    throw StorageError("object '" + record.name + "' is a " + record.kind + ", expected a " + expected_kind);
  }
}

void FieldReader::expect(bool condition, const std::string& name, const std::string& expectation) const {
  if (condition) return;
  throw StorageError(record_.kind + " '" + record_.name + "': field '" + name + "': expected " + expectation);
}

template <typename T>
const T& FieldReader::get(const std::string& name, const char* type) const {
  const auto found = record_.fields.find(name);
  expect(found != record_.fields.end(), name, std::string(type) + ", but it is missing");
  const T* value = std::get_if<T>(&found->second);
  expect(value != nullptr, name, std::string(type) + ", found another type");
  return *value;
}

double FieldReader::number(const std::string& name) const { return get<double>(name, "a number"); }

std::optional<double> FieldReader::optional_number(const std::string& name) const {
  if (!record_.fields.contains(name)) return std::nullopt;
  return number(name);
}

std::int64_t FieldReader::integer(const std::string& name) const { return get<std::int64_t>(name, "an integer"); }

int FieldReader::small_integer(const std::string& name) const {
  const std::int64_t value = integer(name);
  expect(value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max(), name,
         "an integer of 32 bits");
  return static_cast<int>(value);
}

const std::string& FieldReader::text(const std::string& name) const { return get<std::string>(name, "a text"); }

const std::vector<std::string>& FieldReader::texts(const std::string& name) const {
  return get<std::vector<std::string>>(name, "a list of texts");
}

const Eigen::VectorXd& FieldReader::vector(const std::string& name) const {
  return get<Eigen::VectorXd>(name, "an array of rank 1");
}

const Eigen::MatrixXd& FieldReader::matrix(const std::string& name) const {
  return get<Eigen::MatrixXd>(name, "an array of rank 2");
}

std::size_t FieldReader::position(const std::string& name, std::span<const std::string_view> names) const {
  const std::string& value = text(name);
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) {
    std::string list;
    for (const auto option : names) list += (list.empty() ? "" : ", ") + std::string(option);
    expect(false, name, "one of " + list + ", found '" + value + "'");
  }
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace opponens::storage
