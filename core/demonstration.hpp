// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace opponens {

enum class Origin { recorded, simulated };

/// One movement of a hand, sampled: a glove recording, or the same mapped to a robot hand. T samples, n channels.
struct Demonstration {
  std::string id;                             ///< unique in its source, e.g. "s1_scissors_r1"
  std::map<std::string, std::string> labels;  ///< subject, object, grasp_type, family, repetition, ...
  Origin origin = Origin::recorded;           ///< a simulated one is never shown without that word
  double weight = 1.0;                        ///< of this recording in pooled statistics
  Eigen::VectorXd time;                       ///< [T] s, strictly increasing
  std::vector<std::string> joint_names;       ///< [n]
  Eigen::MatrixXd q_h;                        ///< [T x n] rad, row = sample
  std::optional<double> known_transition;     ///< s, ground truth of the phase change: simulated movements only
};

}  // namespace opponens
