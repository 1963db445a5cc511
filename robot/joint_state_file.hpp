// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: joint states in MoveIt's YAML.

#include <string>
#include <vector>

#include "robot/motion_request.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

/// Joint positions of a moveit_msgs/RobotState. What it attaches to the robot or places in the plane is noted.
JointState read_robot_state(const YamlValue& state, std::vector<std::string>& notes);

}  // namespace opponens::robot
