// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/robot_arms.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "robot/tree.hpp"

namespace opponens::robot {

namespace {

void append(std::vector<std::string>& names, const std::vector<std::string>& more) {
  names.insert(names.end(), more.begin(), more.end());
}

void append(std::vector<SurfacePoint>& points, std::vector<SurfacePoint> more, const std::string& prefix) {
  for (SurfacePoint& point : more) {
    if (!prefix.empty()) {
      point.name = prefixed(prefix, point.name);
      point.finger = prefixed(prefix, point.finger);
    }
    points.push_back(std::move(point));
  }
}

}  // namespace

std::vector<std::string> arm_choices(const RobotDescription& robot) {
  std::vector<std::string> choices;
  for (const ArmDescription& arm : robot.arms) choices.push_back(arm.name);
  if (choices.size() == 2) choices.emplace_back(kBothArms);
  return choices;
}

RobotDescription drive_arms(const RobotDescription& robot, const std::string& group) {
  const std::vector<std::string> choices = arm_choices(robot);
  require(std::find(choices.begin(), choices.end(), group) != choices.end(),
          "robot '" + robot.name + "' has no arm '" + group + "' to drive");
  std::vector<const ArmDescription*> driven;
  for (const ArmDescription& arm : robot.arms) {
    if (group == kBothArms || group == arm.name) driven.push_back(&arm);
  }
  RobotDescription result = robot;
  for (auto* names : {&result.driven_arms, &result.arm_joints, &result.hand_joints}) names->clear();
  for (auto* points : {&result.tips, &result.contact_points}) points->clear();
  result.palm_link = driven[0]->palm_link;
  result.arm_tip_link = driven[0]->arm_tip_link;
  std::vector<double> arm_weights;
  std::vector<double> hand_weights;
  for (const ArmDescription* arm : driven) {
    result.driven_arms.push_back(arm->name);
    append(result.arm_joints, arm->arm_joints);
    append(result.hand_joints, arm->hand_joints);
    const std::string prefix = driven.size() > 1 ? arm->name : "";
    append(result.tips, arm->tips, prefix);
    append(result.contact_points, arm->contact_points, prefix);
    const auto split = arm->weights.begin() + static_cast<Eigen::Index>(arm->arm_joints.size());
    arm_weights.insert(arm_weights.end(), arm->weights.begin(), split);
    hand_weights.insert(hand_weights.end(), split, arm->weights.end());
  }
  arm_weights.insert(arm_weights.end(), hand_weights.begin(), hand_weights.end());
  result.weights = Eigen::Map<Eigen::VectorXd>(arm_weights.data(), static_cast<Eigen::Index>(arm_weights.size()));
  return result;
}

}  // namespace opponens::robot
