// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "robot/finger.hpp"
#include "robot/hand_mapping.hpp"

namespace opponens::robot {

/// Where a robot finger's tip should be.
struct TipTarget {
  Finger finger;
  std::vector<int> joints;  ///< indices into q of the fitted joints that move it
  Eigen::Matrix3Xd path;    ///< [3 x T] m, palm frame
  int turning_link = 0;     ///< link that the first of them (from the palm) turns; its origin lies on the axis
  Eigen::Vector3d turning_axis = Eigen::Vector3d::UnitZ();  ///< of that joint, unit, in that link
};

/// Moves the fitted joints' rows of q [d x T] so that the tips follow their targets (the problem of retarget()). Starts
/// from the values in q. Returns why not, when the solver did not meet its tolerance.
std::optional<Failure> fit_fingertips(const RobotModel& hand, const std::vector<TipTarget>& targets,
                                      const std::vector<int>& fitted, const RetargetSettings& settings,
                                      Eigen::MatrixXd& q);

}  // namespace opponens::robot
