// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/grasp.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::motion {

/// Lines 6-7 of Algorithm 1 for one grasp: inverse kinematics of pre-grasp and grasp on the same branch, limits, and
/// collision with scene and self at both (object contacts excepted at the grasp). Fills grasp.arm_solutions.
/// Returns an empty string when at least one solution is left, else the reason ("no IK", "arm collision", ...).
/// free_space: checker with everything; closing: checker that lets hand and object touch.
std::string reach(Grasp& grasp, const robot::RobotModel& robot, const robot::ArmKinematics& kinematics,
                  const Eigen::Isometry3d& X_RO, const robot::CollisionChecker& free_space,
                  const robot::CollisionChecker& closing, double resolution);

}  // namespace opponens::motion
