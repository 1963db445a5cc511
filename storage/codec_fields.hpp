// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: typed access to the fields of a record, shared by the codecs.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "storage/record.hpp"

namespace opponens::storage {

/// The text of an enumerator whose values count from 0 in the order of names.
template <typename Enum>
std::string enum_text(std::span<const std::string_view> names, Enum value) {
  return std::string(names[static_cast<std::size_t>(value)]);
}

/// Every access throws StorageError naming record and field when the field is missing or of another type.
class FieldReader {
 public:
  FieldReader(const Record& record, const std::string& expected_kind);

  double number(const std::string& name) const;
  std::optional<double> optional_number(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  int small_integer(const std::string& name) const;  ///< fits an int
  const std::string& text(const std::string& name) const;
  const std::vector<std::string>& texts(const std::string& name) const;
  const Eigen::VectorXd& vector(const std::string& name) const;
  const Eigen::MatrixXd& matrix(const std::string& name) const;
  template <typename Enum>
  Enum enumerator(const std::string& name, std::span<const std::string_view> names) const {
    return static_cast<Enum>(position(name, names));
  }

  /// Throws StorageError "field 'name': expected ..." unless condition holds.
  void expect(bool condition, const std::string& name, const std::string& expectation) const;

 private:
  template <typename T>
  const T& get(const std::string& name, const char* type) const;
  std::size_t position(const std::string& name, std::span<const std::string_view> names) const;

  const Record& record_;
};

}  // namespace opponens::storage
