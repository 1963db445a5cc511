// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "core/require.hpp"
#include "robot/hand_outline.hpp"
#include "robot/link_pairs.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {

namespace {

/// Whether a link hangs on another, or is it.
bool is_below(const RobotDescription& description, int link, int ancestor) {
  while (link != ancestor) {
    const int joint = description.links[static_cast<std::size_t>(link)].joint;
    if (joint < 0) return false;
    link = description.joints[static_cast<std::size_t>(joint)].parent;
  }
  return true;
}

/// The deepest link below the root that has geometry or moves: where an arm ends.
int last_link(const RobotDescription& description) {
  std::vector<int> moving(description.links.size(), 0);  // joints from the root that move
  int last = 0;
  for (const Joint& joint : description.joints) {
    int& mine = moving[static_cast<std::size_t>(joint.child)];
    mine = moving[static_cast<std::size_t>(joint.parent)] + (joint.type == JointType::fixed ? 0 : 1);
    if (mine > moving[static_cast<std::size_t>(last)]) last = joint.child;
  }
  return last;
}

/// Joints are the hand's below the palm, the arm's on the way to it; others (a second arm) rest.
void split_joints(RobotDescription& description, int palm) {
  std::string resting;
  for (const Joint& joint : description.joints) {
    if (joint.type == JointType::fixed || joint.mimic) continue;
    if (joint.child != palm && is_below(description, joint.child, palm)) {
      description.hand_joints.push_back(joint.name);
    } else if (is_below(description, palm, joint.child)) {
      description.arm_joints.push_back(joint.name);
    } else {
      resting += (resting.empty() ? "" : ", ") + joint.name;
    }
  }
  if (!resting.empty()) description.notes.push_back("joints that lead elsewhere rest near zero: " + resting);
}

}  // namespace

RobotDescription load_urdf(const std::filesystem::path& urdf, const UrdfSettings& settings) {
  RobotDescription description = read_urdf(urdf, settings);
  const std::optional<int> palm = find_palm(description);
  const int hand_root = palm.value_or(last_link(description));
  description.palm_link = description.links[static_cast<std::size_t>(hand_root)].name;
  description.notes.push_back(palm ? "the palm is taken to be '" + description.palm_link + "', where the fingers branch"
                                   : "nothing branches, so there is no hand: '" + description.palm_link +
                                         "' ends the arm");
  split_joints(description, hand_root);
  const int joint = description.links[static_cast<std::size_t>(hand_root)].joint;
  if (!description.arm_joints.empty() && joint >= 0) {
    const int parent = palm ? description.joints[static_cast<std::size_t>(joint)].parent : hand_root;
    description.arm_tip_link = description.links[static_cast<std::size_t>(parent)].name;
  }
  const auto joints = static_cast<Eigen::Index>(description.arm_joints.size() + description.hand_joints.size());
  if (joints == 0) throw InputError(urdf.string() + ": has no joint that moves");
  description.weights = Eigen::VectorXd::Ones(joints);
  allow_adjacent(description);
  description.files = {urdf};
  for (const Link& link : description.links) append_mesh_files(link.collision, description.files);
  return description;
}

}  // namespace opponens::robot
