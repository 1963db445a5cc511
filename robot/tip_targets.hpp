// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "robot/fingertip_fit.hpp"

namespace opponens::robot {

/// One mapped fingertip as both hands have it.
struct FingerPair {
  std::string tip;  ///< of the robot
  Finger robot;
  Finger human;
};

/// By name of the robot tip. Failure: a tip is missing (not_found).
Result<std::vector<FingerPair>> mapped_fingers(const RobotModel& human, const RobotModel& hand,
                                               const HandMapping& mapping);

/// Robot hand joints that move at least one mapped fingertip, as indices into q.
std::vector<int> moving_joints(const std::vector<FingerPair>& fingers);

/// Targets of MappingKind::paper; joints [fitted] are those that its problem moves. Failure: a tip is measured from one
/// that is not mapped (not_found), a fitted joint moves no tip (degenerate).
Result<std::vector<TipTarget>> finger_targets(const RobotModel& human, const Eigen::MatrixXd& q_human,
                                              const RobotModel& hand, const HandMapping& mapping,
                                              const std::vector<FingerPair>& fingers, const std::vector<int>& fitted);

/// Targets of an alignment.
std::vector<TipTarget> aligned_targets(const RobotModel& human, const Eigen::MatrixXd& q_human,
                                       const HandAlignment& alignment, const Eigen::Matrix3d& R_robot_human,
                                       const std::vector<FingerPair>& fingers);

}  // namespace opponens::robot
