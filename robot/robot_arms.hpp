// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// The name that stands for the two arms of a robot.
inline constexpr const char* kBothArms = "both";

/// What drive_arms accepts for this robot: the names of its arms, and "both" where there are two.
std::vector<std::string> arm_choices(const RobotDescription& robot);

/// The same robot with another choice of the arms that q drives: one by name, or "both" of two. The others stand at
/// their rest positions, in the way of whatever moves. With both, q = [q_a of each; q_h of each] in the file's order,
/// the palm is the first arm's, and surface points of several hands are told apart by the arm's name: "left/index".
/// Throws std::invalid_argument when group is none of arm_choices.
RobotDescription drive_arms(const RobotDescription& robot, const std::string& group);

}  // namespace opponens::robot
