// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/attached_body.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "robot/link_pairs.hpp"
#include "robot/tree.hpp"

namespace opponens::robot {

namespace {

int require_link(const RobotDescription& robot, const std::string& name) {
  const std::optional<int> index = find_link(robot, name);
  require(index.has_value(), "attach_body: no link '" + name + "' in robot '" + robot.name + "'");
  return *index;
}

}  // namespace

RobotDescription attach_body(const RobotDescription& robot, const SceneBody& body, const std::string& link,
                             const Eigen::Isometry3d& X_LB, const std::vector<std::string>& touch_links) {
  const int parent = require_link(robot, link);
  require(!find_link(robot, body.name), "attach_body: robot '" + robot.name + "' has a link '" + body.name + "'");
  require(X_LB.matrix().allFinite(), "attach_body: the pose of '" + body.name + "' is not finite");
  RobotDescription part;
  part.links.push_back({body.name, -1, body.geometry});
  RobotDescription holding = robot;
  const int held = append_tree(holding, part, parent, X_LB, "held_" + body.name);
  allow_adjacent(holding);
  for (const std::string& touched : touch_links) {
    holding.allowed_collisions.emplace(require_link(robot, touched), held);
  }
  return holding;
}

Scene without_body(const Scene& scene, const std::string& body) {
  Scene rest = scene;
  const std::size_t removed =
      std::erase_if(rest.bodies, [&](const SceneBody& candidate) { return candidate.name == body; });
  require(removed > 0, "without_body: scene '" + scene.name + "' has no body '" + body + "'");
  if (rest.object == body) rest.object.clear();
  if (rest.support == body) rest.support.clear();
  return rest;
}

}  // namespace opponens::robot
