// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {

/// Fails unless the palm (link index) at q (rad, [d]) is at X_RH in the robot's root, to `tolerance` in m and in rad.
/// `name` begins the reason. This is what ties joint values to the grasp that they claim to reach.
void check_palm(const robot::RobotModel& robot, const Eigen::VectorXd& q, int palm, const Eigen::Isometry3d& X_RH,
                const std::string& name, double tolerance, Verdict& verdict);

}  // namespace opponens::verify
