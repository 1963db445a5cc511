// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/link_pairs.hpp"

namespace opponens::robot {

std::optional<int> find_link(const RobotDescription& description, const std::string& name) {
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    if (description.links[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

std::vector<int> rigid_bodies(const RobotDescription& description) {
  std::vector<int> body(description.links.size(), 0);
  for (const Joint& joint : description.joints) {
    body[static_cast<std::size_t>(joint.child)] =
        joint.type == JointType::fixed ? body[static_cast<std::size_t>(joint.parent)] : joint.child;
  }
  return body;
}

void allow_adjacent(RobotDescription& description) {
  for (const Joint& joint : description.joints) description.allowed_collisions.emplace(joint.parent, joint.child);
  const std::vector<int> body = rigid_bodies(description);
  const int links = static_cast<int>(description.links.size());
  for (int a = 0; a < links; ++a) {
    for (int b = a + 1; b < links; ++b) {
      if (body[static_cast<std::size_t>(a)] == body[static_cast<std::size_t>(b)]) {
        description.allowed_collisions.emplace(a, b);
      }
    }
  }
}

}  // namespace opponens::robot
