// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "analysis/simulate.hpp"
#include "core/rng.hpp"

namespace opponens::analysis::test {

inline Eigen::MatrixXd normal_matrix(Eigen::Index rows, Eigen::Index columns, Rng& rng) {
  Eigen::MatrixXd result(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) result(i, j) = rng.normal();
  }
  return result;
}

inline Eigen::VectorXd vector(const YAML::Node& node) {
  const auto values = node.as<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// One stream per trial, so that a failing trial can be repeated alone.
inline Rng numbered_stream(std::uint64_t seed, std::string name, int number) {
  return stream(seed, name.append(std::to_string(number)));
}

/// models/human/grasp_types.yaml as a SimulationModel.
inline SimulationModel human_model() {
  const YAML::Node file = YAML::LoadFile(std::string(OPPONENS_SOURCE_DIR) + "/models/human/grasp_types.yaml");
  SimulationModel model;
  model.channels = file["channels"].as<std::vector<std::string>>();
  model.fingers = file["fingers"].as<std::vector<std::string>>();
  model.lower = vector(file["lower"]);
  model.upper = vector(file["upper"]);
  model.rest = vector(file["rest"]);
  model.open = vector(file["open"]);
  for (const auto& node : file["types"]) {
    SimulatedGraspType type;
    type.name = node["name"].as<std::string>();
    type.family = node["family"].as<std::string>();
    type.family_assumed = node["assumed"].as<bool>();
    for (const auto& end : node["ends"]) type.ends.push_back({end["object"].as<std::string>(), vector(end["posture"])});
    model.types.push_back(type);
  }
  return model;
}

/// A recording of T samples at 50 Hz with the given rows.
inline Demonstration recording(const std::string& id, const Eigen::MatrixXd& q) {
  Demonstration result;
  result.id = id;
  result.q_h = q;
  result.time = Eigen::VectorXd::LinSpaced(q.rows(), 0.0, 0.02 * static_cast<double>(q.rows() - 1));
  for (Eigen::Index j = 0; j < q.cols(); ++j) result.joint_names.push_back(std::string(1, static_cast<char>('a' + j)));
  return result;
}

/// Two straight legs with a corner at the given share of the movement, minimum-jerk each, in n channels.
inline Demonstration two_phases(int samples, int channels, double corner, double noise, Rng& rng) {
  const Eigen::RowVectorXd first = 0.6 * normal_matrix(1, channels, rng);
  const Eigen::RowVectorXd second = 0.6 * normal_matrix(1, channels, rng);
  const double change = corner * (samples - 1);
  Eigen::MatrixXd q(samples, channels);
  for (int i = 0; i < samples; ++i) {
    q.row(i) = minimum_jerk(i / change) * first + minimum_jerk((i - change) / (samples - 1 - change)) * second;
  }
  q += noise * normal_matrix(samples, channels, rng);
  Demonstration result = recording("two_phases", q);
  result.known_transition = 0.02 * change;
  return result;
}

}  // namespace opponens::analysis::test
