// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/result.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Where a named tip of the hand should be.
struct TipPosition {
  std::string tip;
  Eigen::Vector3d p_H;  ///< m, palm frame
};

struct HandShape {
  Eigen::VectorXd q;     ///< [d] rad, inside the limits; joints that move none of the tips are where they were
  Eigen::VectorXd miss;  ///< [tips] m, distance of each tip to its position
};

struct HandShapeSettings {
  double tolerance = 1e-7;   ///< m, of every tip; infinity: the nearest shape is wanted, whatever it misses
  int restarts = 20;         ///< from random joint positions, while a tip misses its position
  int max_iterations = 100;  ///< of the solver, from one start
  std::uint64_t seed = 1;    ///< of the random positions
};

/// Inverse kinematics of several fingertips at once: the joints that move them, mimic joints following theirs, by the
/// least-squares problem of fit_fingertips (Ceres, bounded) on one sample, without weights on the posture; first from
/// start [d], then from random positions. Where fingers have more joints than their tips need, the shape is the one
/// that the descent from there comes to. Deterministic. Failure: not_found (no such tip), out_of_reach (every start
/// ended in a minimum that misses by more than the tolerance) or not_converged, with the least miss. Throws
/// std::invalid_argument unless start fits the robot and the positions are finite.
Result<HandShape> shape_hand(const RobotModel& hand, const std::vector<TipPosition>& tips, const Eigen::VectorXd& start,
                             const HandShapeSettings& settings = {});

}  // namespace opponens::robot
