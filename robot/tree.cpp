// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/tree.hpp"

namespace opponens::robot {

int append_tree(RobotDescription& robot, const RobotDescription& tree, int parent, const Eigen::Isometry3d& X_PT,
                const std::string& joint_name) {
  const int link_offset = static_cast<int>(robot.links.size());
  const int joint_offset = static_cast<int>(robot.joints.size()) + 1;
  Joint mount;
  mount.name = joint_name;
  mount.parent = parent;
  mount.child = link_offset;
  mount.X_PJ = X_PT;
  robot.joints.push_back(std::move(mount));
  for (Joint joint : tree.joints) {
    joint.parent += link_offset;
    joint.child += link_offset;
    robot.joints.push_back(std::move(joint));
  }
  for (Link link : tree.links) {
    link.joint = link.joint < 0 ? joint_offset - 1 : link.joint + joint_offset;
    robot.links.push_back(std::move(link));
  }
  for (const auto& [a, b] : tree.allowed_collisions) {
    robot.allowed_collisions.emplace(a + link_offset, b + link_offset);
  }
  robot.notes.insert(robot.notes.end(), tree.notes.begin(), tree.notes.end());
  return link_offset;
}

std::string prefixed(const std::string& part, const std::string& name) { return part + "/" + name; }

void add_prefix(RobotDescription& tree, const std::string& part) {
  for (Link& link : tree.links) link.name = prefixed(part, link.name);
  for (Joint& joint : tree.joints) {
    joint.name = prefixed(part, joint.name);
    if (joint.mimic) joint.mimic->joint = prefixed(part, joint.mimic->joint);
  }
  for (auto* names : {&tree.arm_joints, &tree.hand_joints}) {
    for (std::string& name : *names) name = prefixed(part, name);
  }
  for (std::string* name : {&tree.palm_link, &tree.arm_tip_link}) {
    if (!name->empty()) *name = prefixed(part, *name);
  }
}

void remove_joint_prefix(RobotDescription& tree, const std::string& part) {
  const std::size_t length = prefixed(part, "").size();
  for (Joint& joint : tree.joints) {
    joint.name.erase(0, length);
    if (joint.mimic) joint.mimic->joint.erase(0, length);
  }
  for (std::string& name : tree.hand_joints) name.erase(0, length);
}

}  // namespace opponens::robot
