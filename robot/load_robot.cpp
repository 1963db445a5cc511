// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/load_robot.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "robot/arm_file.hpp"
#include "robot/arms_file.hpp"
#include "robot/hand_file.hpp"
#include "robot/link_pairs.hpp"
#include "robot/named_links.hpp"
#include "robot/tree.hpp"

namespace opponens::robot {

RobotDescription load_hand(const std::filesystem::path& hand_yaml) {
  return load_hand(hand_yaml, MissingMeshes::refuse);
}

RobotDescription load_hand(const std::filesystem::path& hand_yaml, MissingMeshes missing) {
  return load_hand(hand_yaml, read_hand_file(hand_yaml).urdf.path(), missing);
}

RobotDescription load_hand(const std::filesystem::path& hand_yaml, const std::filesystem::path& urdf,
                           MissingMeshes missing) {
  HandFile hand = read_hand_file(hand_yaml);
  hand.urdf_settings.missing_meshes = missing;
  const RobotDescription whole = read_urdf(urdf, hand.urdf_settings);
  require_links(hand.without_geometry, whole, whole);
  RobotDescription description = subtree(whole, require_link(whole, hand.palm_link));
  fill_hand(description, hand);
  description.weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(description.hand_joints.size()));
  description.files = {hand_yaml, urdf};
  add_files_inside(description);
  return description;
}

RobotDescription hand_of(const RobotDescription& robot) {
  require(robot.driven_arms.size() < 2, "hand_of: q drives several arms of robot '" + robot.name + "'");
  const auto index = [](const RobotDescription& tree, const std::string& name) { return *find_link(tree, name); };
  RobotDescription hand = subtree(robot, index(robot, robot.palm_link));
  const auto name = [&](int link) { return robot.links[static_cast<std::size_t>(link)].name; };
  hand.palm_link = robot.palm_link;
  hand.hand_joints = robot.hand_joints;
  hand.tips = robot.tips;
  hand.contact_points = robot.contact_points;
  for (auto* points : {&hand.tips, &hand.contact_points}) {
    for (SurfacePoint& point : *points) point.link = index(hand, name(point.link));
  }
  for (const auto& [a, b] : robot.allowed_collisions) {
    const auto first = find_link(hand, name(a));
    const auto second = find_link(hand, name(b));
    if (first && second) hand.allowed_collisions.emplace(std::min(*first, *second), std::max(*first, *second));
  }
  hand.weights = robot.weights.tail(static_cast<Eigen::Index>(robot.hand_joints.size()));
  hand.files = robot.files;
  if (!robot.driven_arms.empty()) remove_joint_prefix(hand, robot.driven_arms[0]);
  return hand;
}

RobotDescription load_robot(const std::filesystem::path& robot_yaml, const std::string& group, MissingMeshes missing) {
  const YamlValue file = YamlValue::load(robot_yaml);
  if (file.has("arms")) return load_arms(file, group, missing);
  if (!group.empty()) file.fail("has one arm and no key 'arms', so there is no arm '" + group + "' to choose");
  file.allow_keys({"name", "arm", "hand", "mount", "collision", "without_geometry", "weights", "accelerations",
                   "allowed_collisions", "srdf"});
  return load_arm(file, {read_link_geometry(file), missing});
}

}  // namespace opponens::robot
