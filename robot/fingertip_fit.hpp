// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "robot/finger.hpp"
#include "robot/hand_mapping.hpp"

namespace opponens::robot {

/// A fitted joint as seen from a fingertip.
struct FittedJoint {
  int link = -1;         ///< the joint's child link: its origin lies on the axis
  Eigen::Vector3d axis;  ///< unit, in that link
  bool revolute = true;
};

/// Where a robot finger's tip should be.
struct TipTarget {
  Finger finger;
  std::vector<int> joints;             ///< indices into q of the fitted joints that move it, palm first
  std::map<int, FittedJoint> turning;  ///< by index into q
  Eigen::Matrix3Xd path;               ///< [3 x T] m, palm frame
};

/// Start values for fit_fingertips: cyclic coordinate descent, one fitted joint at a time, sample after sample. Exact
/// for a finger with one fitted joint but for the small weights of smoothness and rest.
void seed_positions(const RobotModel& hand, const std::vector<TipTarget>& targets, const std::vector<int>& fitted,
                    Eigen::MatrixXd& q);

/// Moves the fitted joints' rows of q [d x T] so that the tips follow their targets (the problem of retarget()).
/// Returns why not, when the solver did not meet its tolerance.
std::optional<Failure> fit_fingertips(const RobotModel& hand, const std::vector<TipTarget>& targets,
                                      const std::vector<int>& fitted, const RetargetSettings& settings,
                                      Eigen::MatrixXd& q);

}  // namespace opponens::robot
