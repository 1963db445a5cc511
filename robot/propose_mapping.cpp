// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/propose_mapping.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <Eigen/Geometry>

#include "robot/phalanges.hpp"

namespace opponens::robot {

namespace {

/// Flexion channels of a human finger, palm first; empty for another name.
std::vector<std::string> channels_of(const std::string& finger) {
  static const std::map<std::string, std::string> kLetters = {
      {"index", "I"}, {"middle", "M"}, {"ring", "R"}, {"little", "L"}};
  if (finger == "thumb") return {"T_MCP", "T_IP"};
  const auto letter = kLetters.find(finger);
  if (letter == kLetters.end()) return {};
  return {letter->second + "_MCP", letter->second + "_PIP", letter->second + "_DIP"};
}

const std::string& joint_name(const RobotModel& robot, int joint) {
  return robot.description().joints[static_cast<std::size_t>(joint)].name;
}

/// Copies for the finger's outermost phalanges: a thumb's last two joints, the last three of the others. A finger with
/// fewer has the channels from the palm on.
void copy_phalanges(const RobotModel& robot, const FingerBones& finger, const std::vector<std::string>& channels,
                    HandMapping& mapping) {
  std::vector<const Phalanx*> driven;
  for (const Phalanx& phalanx : finger.phalanges) {
    if (!robot.description().joints[static_cast<std::size_t>(phalanx.joint)].mimic) driven.push_back(&phalanx);
  }
  const std::size_t count = std::min(channels.size(), driven.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Phalanx& phalanx = *driven[driven.size() - count + i];
    mapping.copied.push_back({joint_name(robot, phalanx.joint), channels[i], phalanx.sense, 0.0, false});
  }
}

/// Whether the thumb ends on the other side of the fingers than a right hand's. y: from the little finger's side to the
/// thumb's in a right hand's palm, unit.
bool is_left(const std::vector<FingerBones>& fingers, const Eigen::Vector3d& y) {
  constexpr double kClear = 0.01;  // m: hands whose thumb is in the middle are neither
  double thumb = 0.0;
  double others = 0.0;
  int count = 0;
  for (const FingerBones& finger : fingers) {
    if (finger.phalanges.empty()) continue;
    if (finger.thumb) thumb = y.dot(finger.end());
    if (!finger.thumb) others += y.dot(finger.end());
    count += finger.thumb ? 0 : 1;
  }
  const bool has_thumb = std::any_of(fingers.begin(), fingers.end(), [](const auto& finger) { return finger.thumb; });
  return has_thumb && count > 0 && thumb - others / count < -kClear;
}

}  // namespace

std::optional<HandMapping> propose_mapping(const RobotModel& robot) {
  const std::vector<FingerBones> fingers = finger_bones(robot, rest_in_palm(robot));
  const PalmDirections palm = palm_directions(fingers);
  HandMapping mapping;
  std::set<std::string> joints;  // of the mapped fingers
  for (const FingerBones& finger : fingers) {
    const std::vector<std::string> channels = channels_of(finger.name);
    if (channels.empty() || finger.phalanges.empty()) continue;
    for (const int joint : finger.joints) joints.insert(joint_name(robot, joint));
    copy_phalanges(robot, finger, channels, mapping);
    mapping.fingertips[finger.name] = finger.name;
  }
  const Eigen::Vector3d along = palm.ahead - palm.side * palm.side.dot(palm.ahead);
  if (mapping.fingertips.empty() || palm.side.norm() == 0.0 || along.norm() < 0.1) return std::nullopt;
  if (mapping.fingertips.contains("thumb") && mapping.fingertips.contains("index")) {
    mapping.measured_from["thumb"] = "index";
  }
  for (const JointMapping& copy : mapping.copied) joints.erase(copy.joint);
  for (const std::string& joint : robot.description().hand_joints) {
    if (joints.contains(joint)) mapping.fitted.push_back(joint);
  }
  mapping.R_robot_human.col(0) = palm.side;
  mapping.R_robot_human.col(2) = along.normalized();
  mapping.R_robot_human.col(1) = mapping.R_robot_human.col(2).cross(mapping.R_robot_human.col(0));
  if (is_left(fingers, mapping.R_robot_human.col(1))) return std::nullopt;
  return mapping;
}

}  // namespace opponens::robot
