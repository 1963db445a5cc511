// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace opponens::cli {

using Json = nlohmann::json;

/// Version of the documents that --json prints; a field is renamed only together with it.
inline constexpr int kDocumentSchema = 1;

inline Json document(const std::string& command) { return {{"schema", kDocumentSchema}, {"command", command}}; }

/// JSON has no NaN: a number that is not finite is null.
inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

/// The other way: null is no number.
inline std::optional<double> optional_number(const Json& json) {
  return json.is_number() ? std::optional<double>(json.get<double>()) : std::nullopt;
}

template <typename Derived>
Json array(const Eigen::DenseBase<Derived>& values) {
  Json result = Json::array();
  for (Eigen::Index i = 0; i < values.size(); ++i) result.push_back(number(values(i)));
  return result;
}

/// Rows of a matrix as arrays.
template <typename Derived>
Json rows(const Eigen::MatrixBase<Derived>& values) {
  Json result = Json::array();
  for (Eigen::Index i = 0; i < values.rows(); ++i) result.push_back(array(values.row(i)));
  return result;
}

/// 16 numbers, row-major.
inline Json pose(const Eigen::Isometry3d& X) {
  Json result = Json::array();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) result.push_back(X.matrix()(i, j));
  }
  return result;
}

/// {name: value}.
template <typename Derived>
Json by_name(const std::vector<std::string>& names, const Eigen::DenseBase<Derived>& values) {
  Json result = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = number(values(static_cast<Eigen::Index>(i)));
  return result;
}

}  // namespace opponens::cli
