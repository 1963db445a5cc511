// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/record.hpp"

#include <bit>
#include <cmath>
#include <span>

#include "core/require.hpp"
#include "storage/sha256.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

static_assert(std::endian::native == std::endian::little, "canonical bytes are little-endian; a port has to swap");

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Feeds a record's values to the hash in an order and form that no container or HDF5 version can change.
class Canonical {
 public:
  void number(std::uint64_t value) { hash_.update(std::as_bytes(std::span(&value, 1))); }
  void text(const std::string& value) {
    number(value.size());
    hash_.update(std::string_view(value));
  }
  void texts(const std::vector<std::string>& values) {
    number(values.size());
    for (const auto& value : values) text(value);
  }
  void doubles(const double* data, Eigen::Index count) {
    hash_.update(std::as_bytes(std::span(data, static_cast<std::size_t>(count))));
  }
  void operator()(double value) { doubles(&value, 1); }
  void operator()(std::int64_t value) { number(static_cast<std::uint64_t>(value)); }
  void operator()(const std::string& value) { text(value); }
  void operator()(const std::vector<std::string>& values) { texts(values); }
  void operator()(const Eigen::VectorXd& values) {
    number(static_cast<std::uint64_t>(values.size()));
    doubles(values.data(), values.size());
  }
  void operator()(const Eigen::MatrixXd& values) {
    number(static_cast<std::uint64_t>(values.rows()));
    number(static_cast<std::uint64_t>(values.cols()));
    const RowMajor rows = values;
    doubles(rows.data(), rows.size());
  }
  std::string hex() { return hash_.hex(); }

 private:
  Sha256 hash_;
};

void check_text(const std::string& text, const std::string& where) {
  require(text.find('\0') == std::string::npos, [&] { return where + ": a stored string cannot hold a zero byte"; });
  require(is_utf8(text), [&] { return where + ": '" + text + "' is not UTF-8"; });
}

void check_numbers(const double* data, Eigen::Index count, const std::string& where) {
  for (Eigen::Index i = 0; i < count; ++i) {
    require(!std::isnan(data[i]), [&] { return where + ": value " + std::to_string(i) + " is NaN"; });
  }
}

struct FieldCheck {
  const std::string& where;
  void operator()(double value) const { check_numbers(&value, 1, where); }
  void operator()(std::int64_t) const {}
  void operator()(const std::string& value) const { check_text(value, where); }
  void operator()(const std::vector<std::string>& values) const {
    for (const auto& value : values) check_text(value, where);
  }
  void operator()(const Eigen::VectorXd& values) const { check_numbers(values.data(), values.size(), where); }
  void operator()(const Eigen::MatrixXd& values) const { check_numbers(values.data(), values.size(), where); }
};

bool is_array(const Field& field) { return field.index() >= 3; }

}  // namespace

std::string content_hash(const Record& record) {
  Canonical bytes;
  bytes.text("opponens record 1");
  bytes.text(record.kind);
  bytes.text(record.name);
  bytes.text(record.provenance.command);
  bytes.texts(record.provenance.inputs);
  bytes.number(record.provenance.files.size());
  for (const auto& [file, hash] : record.provenance.files) {
    bytes.text(file);
    bytes.text(hash);
  }
  bytes.text(record.provenance.parameters);
  bytes.number(record.provenance.seed);
  bytes.text(record.provenance.program_version);
  bytes.number(record.fields.size());
  for (const auto& [name, field] : record.fields) {
    bytes.text(name);
    bytes.number(field.index());
    std::visit(bytes, field);
  }
  return bytes.hex();
}

void check_storable(const Record& record) {
  require(!record.kind.empty(), "a stored record needs a kind");
  const std::string label = record.kind + " '" + record.name + "'";
  check_text(record.kind, label + ", kind");
  check_text(record.name, label + ", name");
  check_text(record.provenance.command, label + ", provenance command");
  check_text(record.provenance.parameters, label + ", provenance parameters");
  check_text(record.provenance.program_version, label + ", provenance program_version");
  for (const auto& input : record.provenance.inputs) check_text(input, label + ", provenance inputs");
  for (const auto& [file, hash] : record.provenance.files) {
    require(!file.empty(), label + ", provenance files: an outside file needs a name");
    check_text(file, label + ", provenance files");
    check_text(hash, label + ", provenance files");
  }
  for (const auto& [name, field] : record.fields) {
    std::string where = label;
    where.append(", field '").append(name).append("'");
    require(!name.empty(), [&] { return where + ": a field needs a name"; });
    check_text(name, where);
    require(!is_array(field) || (name != "." && name.find('/') == std::string::npos),
            [&] { return where + ": an array's name cannot be '.' or hold '/'"; });
    std::visit(FieldCheck{where}, field);
  }
}

}  // namespace opponens::storage
