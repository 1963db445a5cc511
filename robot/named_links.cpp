// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/named_links.hpp"

#include <algorithm>

#include "robot/link_pairs.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {

int require_link(const RobotDescription& description, const NamedValue& link) {
  const std::optional<int> index = find_link(description, link.name);
  if (!index) link.where.fail("no link '" + link.name + "' in the URDF");
  return *index;
}

void require_links(const std::vector<NamedValue>& names, const RobotDescription& one, const RobotDescription& other) {
  for (const NamedValue& link : names) {
    if (!find_link(one, link.name)) require_link(other, link);
  }
}

void require_actuated(const RobotDescription& description, const NamedValue& name) {
  const auto joint = std::find_if(description.joints.begin(), description.joints.end(),
                                  [&](const Joint& candidate) { return candidate.name == name.name; });
  if (joint == description.joints.end()) name.where.fail("no joint '" + name.name + "' in the URDF");
  if (joint->type == JointType::fixed) name.where.fail("joint '" + name.name + "' is fixed");
  if (joint->mimic) name.where.fail("joint '" + name.name + "' mimics '" + joint->mimic->joint + "'");
}

void allow_pairs(RobotDescription& description, const std::vector<std::pair<NamedValue, NamedValue>>& pairs) {
  for (const auto& [first, second] : pairs) {
    const int a = require_link(description, first);
    const int b = require_link(description, second);
    description.allowed_collisions.emplace(std::min(a, b), std::max(a, b));
  }
}

namespace {

std::vector<SurfacePoint> resolve(const RobotDescription& description, const std::vector<NamedPoint>& named) {
  std::vector<SurfacePoint> points;
  for (const NamedPoint& point : named) {
    points.push_back(point.point);
    points.back().link = require_link(description, point.link);
  }
  return points;
}

}  // namespace

void fill_hand(RobotDescription& description, const HandFile& hand) {
  require_link(description, hand.palm_link);
  description.palm_link = hand.palm_link.name;
  for (const NamedValue& joint : hand.joints) {
    require_actuated(description, joint);
    description.hand_joints.push_back(joint.name);
  }
  description.tips = resolve(description, hand.tips);
  description.contact_points = resolve(description, hand.contact_points);
  allow_adjacent(description);
  allow_pairs(description, hand.allowed_collisions);
  if (hand.srdf) apply_srdf(read_srdf(*hand.srdf), description);
}

void add_files_inside(RobotDescription& description) {
  for (const Srdf& srdf : description.semantics) description.files.push_back(srdf.file);
  for (const Link& link : description.links) append_mesh_files(link.collision, description.files);
}

}  // namespace opponens::robot
