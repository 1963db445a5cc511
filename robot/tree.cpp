// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/tree.hpp"

#include "robot/link_pairs.hpp"

namespace opponens::robot {

RobotDescription subtree(const RobotDescription& whole, int root) {
  RobotDescription part;
  part.name = whole.name;
  part.notes = whole.notes;
  std::vector<int> moved(whole.links.size(), -1);
  for (std::size_t i = 0; i < whole.links.size(); ++i) {
    const Link& link = whole.links[i];
    const int parent = link.joint < 0 ? -1 : whole.joints[static_cast<std::size_t>(link.joint)].parent;
    if (static_cast<int>(i) != root && (parent < 0 || moved[static_cast<std::size_t>(parent)] < 0)) continue;
    moved[i] = static_cast<int>(part.links.size());
    part.links.push_back(link);
    part.links.back().joint = -1;
    if (static_cast<int>(i) == root) continue;
    Joint joint = whole.joints[static_cast<std::size_t>(link.joint)];
    joint.parent = moved[static_cast<std::size_t>(parent)];
    joint.child = moved[i];
    part.links.back().joint = static_cast<int>(part.joints.size());
    part.joints.push_back(std::move(joint));
  }
  for (const MissingMesh& missing : whole.missing_meshes) {
    if (find_link(part, missing.link)) part.missing_meshes.push_back(missing);
  }
  const std::size_t dropped = whole.links.size() - part.links.size();
  if (dropped > 0) {
    part.notes.push_back(std::to_string(dropped) + " links that are not below '" + part.links[0].name + "' left out");
  }
  return part;
}

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
  const auto append = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
  append(robot.notes, tree.notes);
  append(robot.missing_meshes, tree.missing_meshes);
  append(robot.semantics, tree.semantics);
  return link_offset;
}

std::string prefixed(const std::string& part, const std::string& name) { return part + "/" + name; }

void add_prefix(RobotDescription& tree, const std::string& part) {
  for (Link& link : tree.links) link.name = prefixed(part, link.name);
  for (MissingMesh& missing : tree.missing_meshes) missing.link = prefixed(part, missing.link);
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
