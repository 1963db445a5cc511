// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace opponens::storage {

/// Where a stored object came from: what its content hash covers beside its fields. Nothing here differs between two
/// runs with equal inputs (times and host names go to the run log).
struct Provenance {
  std::string command;                       ///< e.g. "analyze"
  std::vector<std::string> inputs;           ///< ids of stored objects it was made from
  std::map<std::string, std::string> files;  ///< outside input file name -> SHA-256 of its bytes
  std::string parameters;                    ///< JSON text of the settings that were in force
  std::uint64_t seed = 0;
  std::string program_version;
};

using Field =
    std::variant<double, std::int64_t, std::string, std::vector<std::string>, Eigen::VectorXd, Eigen::MatrixXd>;

/// A stored object as plain values: what HDF5 holds, and what the content hash is taken of.
struct Record {
  std::string kind;  ///< "demonstration", "synergy_set", "grasp", "path", "document", ...
  std::string name;  ///< for a person: a recording's id, a group's name
  Provenance provenance;
  std::map<std::string, Field> fields;  ///< sorted by name
};

/// SHA-256 (hex) of the canonical bytes of a record (docs/file_format.md). Two doubles are equal here when their bits
/// are: -0.0 is not 0.0.
std::string content_hash(const Record& record);

/// Throws std::invalid_argument naming the field when a record cannot be stored: an empty kind or field name, a string
/// with a zero byte or that is not UTF-8, an array named with '/' or '.', a NaN (an absent value is an absent field;
/// infinities are allowed).
void check_storable(const Record& record);

}  // namespace opponens::storage
