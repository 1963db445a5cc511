// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: the canonical bytes of a record (docs/file_format.md), for the content hash and for the contents
// of a batch file.

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "storage/record.hpp"

namespace opponens::storage {

static_assert(std::endian::native == std::endian::little, "canonical bytes are little-endian; a port has to swap");

/// Type numbers of fields are the positions in Field.
inline constexpr std::uint64_t kVectorType = 4;
inline constexpr std::uint64_t kMatrixType = 5;

/// The order and form of a record's values that no container or HDF5 version can change. Sink has bytes(span of bytes),
/// vector(VectorXd) and matrix(MatrixXd), which get the values of arrays after their shape.
template <typename Sink>
class Canonical {
 public:
  explicit Canonical(Sink& sink) : sink_(sink) {}

  void record(const Record& record) {
    text("opponens record 1");
    text(record.kind);
    text(record.name);
    text(record.provenance.command);
    texts(record.provenance.inputs);
    number(record.provenance.files.size());
    for (const auto& [file, hash] : record.provenance.files) {
      text(file);
      text(hash);
    }
    text(record.provenance.parameters);
    number(record.provenance.seed);
    text(record.provenance.program_version);
    number(record.fields.size());
    for (const auto& [name, field] : record.fields) {
      text(name);
      number(field.index());
      std::visit(*this, field);
    }
  }
  void number(std::uint64_t value) { sink_.bytes(std::as_bytes(std::span(&value, 1))); }
  void text(const std::string& value) {
    number(value.size());
    sink_.bytes(std::as_bytes(std::span(value)));
  }
  void texts(const std::vector<std::string>& values) {
    number(values.size());
    for (const auto& value : values) text(value);
  }
  void operator()(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void operator()(std::int64_t value) { number(static_cast<std::uint64_t>(value)); }
  void operator()(const std::string& value) { text(value); }
  void operator()(const std::vector<std::string>& values) { texts(values); }
  void operator()(const Eigen::VectorXd& values) {
    number(static_cast<std::uint64_t>(values.size()));
    sink_.vector(values);
  }
  void operator()(const Eigen::MatrixXd& values) {
    number(static_cast<std::uint64_t>(values.rows()));
    number(static_cast<std::uint64_t>(values.cols()));
    sink_.matrix(values);
  }

 private:
  Sink& sink_;
};

}  // namespace opponens::storage
