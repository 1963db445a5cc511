// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Positions of some joints.
struct JointState {
  std::vector<std::string> names;
  Eigen::VectorXd positions;  ///< rad or m, by names
};

/// A planning problem in joint space as MoveIt and MotionBenchMaker write it (moveit_msgs/MotionPlanRequest).
struct MotionRequest {
  std::string name;   ///< of the file, without its ending
  std::string group;  ///< planning group; may be empty
  JointState start;
  std::vector<JointState> goals;   ///< one per goal constraint; reaching any of them solves the problem
  std::vector<std::string> notes;  ///< what was ignored
};

/// Throws InputError naming file, line and field. Tolerances of goals are not read: a goal is its centre.
MotionRequest load_motion_request(const std::filesystem::path& request_yaml);

/// A joint state completed to a configuration of a robot.
struct Completed {
  Eigen::VectorXd q;                 ///< [d] rad
  std::vector<std::string> unknown;  ///< joints of the state that the robot lacks
  std::vector<std::string> assumed;  ///< joints of the robot that the state lacks: taken from the fallback
};
/// fallback: [d] rad, for the joints that the state does not name.
Completed complete(const RobotModel& robot, const JointState& state, const Eigen::VectorXd& fallback);

}  // namespace opponens::robot
