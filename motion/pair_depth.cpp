// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/pair_depth.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "motion/contact_depth.hpp"

namespace opponens::motion {
namespace {

bool is_link(const robot::RobotModel& robot, const std::string& name) {
  return std::any_of(robot.links().begin(), robot.links().end(), [&](const auto& link) { return link.name == name; });
}

/// The link as it lies at q, as a body of a scene that holds nothing else.
robot::Scene frozen(const robot::RobotModel& robot, const robot::Scene& scene, const Eigen::VectorXd& q,
                    const std::string& name) {
  const auto link = static_cast<std::size_t>(robot.link_index(name));
  robot::Scene result;
  result.X_WR = scene.X_WR;
  result.bodies = {{name, scene.X_WR * robot.link_poses(q)[link], robot.links()[link].collision}};
  return result;
}

}  // namespace

double pair_depth(const robot::RobotModel& robot, const robot::Scene& scene, const Eigen::VectorXd& q,
                  const robot::BodyPair& pair) {
  double depth = 0.0;
  for (const auto& [link, body] : {pair, robot::BodyPair(pair.second, pair.first)}) {
    if (!is_link(robot, link)) continue;
    const robot::Scene around = is_link(robot, body) ? frozen(robot, scene, q, body) : scene;
    depth = std::max(depth, ContactDepth(robot, around, body, {link})(q));
  }
  return depth;
}

}  // namespace opponens::motion
