// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/record.hpp"

#include <cmath>
#include <span>

#include "core/require.hpp"
#include "storage/canonical.hpp"
#include "storage/sha256.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct HashSink {
  Sha256 hash;
  void bytes(std::span<const std::byte> bytes) { hash.update(bytes); }
  void doubles(const double* data, Eigen::Index count) {
    hash.update(std::as_bytes(std::span(data, static_cast<std::size_t>(count))));
  }
  void vector(const Eigen::VectorXd& values) { doubles(values.data(), values.size()); }
  void matrix(const Eigen::MatrixXd& values) {
    if (values.size() == 0) return;
    const RowMajor rows = values;
    doubles(rows.data(), rows.size());
  }
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
  HashSink sink;
  Canonical<HashSink>(sink).record(record);
  return sink.hash.hex();
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
