// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/load_robot.hpp"

#include <algorithm>
#include <map>

#include "core/require.hpp"
#include "robot/arms_file.hpp"
#include "robot/hand_file.hpp"
#include "robot/link_pairs.hpp"
#include "robot/mesh.hpp"
#include "robot/tree.hpp"

namespace opponens::robot {

namespace {

int require_link(const RobotDescription& description, const NamedValue& link) {
  const std::optional<int> index = find_link(description, link.name);
  if (!index) link.where.fail("no link '" + link.name + "' in the URDF");
  return *index;
}

/// A link named for nothing is a mistyped one, whose shapes would stay. Both: arm and hand may come in two URDFs.
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

/// The tree below a link, which becomes the root.
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
  const std::size_t dropped = whole.links.size() - part.links.size();
  if (dropped > 0) {
    part.notes.push_back(std::to_string(dropped) + " links that are not below '" + part.links[0].name + "' left out");
  }
  return part;
}

/// Appends the hand's tree to a link of the arm.
void attach(RobotDescription& robot, const RobotDescription& hand, int parent, const Eigen::Isometry3d& X_PH,
            const YamlValue& where) {
  for (const Joint& joint : hand.joints) {
    const bool repeats = std::any_of(robot.joints.begin(), robot.joints.end(),
                                     [&](const Joint& other) { return other.name == joint.name; });
    if (repeats) where.fail("arm and hand both have a joint '" + joint.name + "'");
  }
  for (const Link& link : hand.links) {
    if (find_link(robot, link.name)) where.fail("arm and hand both have a link '" + link.name + "'");
  }
  append_tree(robot, hand, parent, X_PH, "mount");
}

/// A part between flange and palm (key mount.support): a cylinder along z, fixed to the mount's parent.
void attach_support(RobotDescription& robot, int parent, const YamlValue& support) {
  support.allow_keys({"name", "radius", "length", "xyz", "rpy"});
  Cylinder cylinder{support.at("radius").number(), support.at("length").number()};
  if (cylinder.radius <= 0.0 || cylinder.length <= 0.0) support.fail("radius and length must be positive");
  RobotDescription part;
  part.links.push_back({support.at("name").text(), -1, {{cylinder, support.pose()}}});
  attach(robot, part, parent, Eigen::Isometry3d::Identity(), support);
  robot.joints.back().name = "mount_" + part.links[0].name;
}

void allow_pairs(RobotDescription& description, const std::vector<std::pair<NamedValue, NamedValue>>& pairs) {
  for (const auto& [first, second] : pairs) {
    const int a = require_link(description, first);
    const int b = require_link(description, second);
    description.allowed_collisions.emplace(std::min(a, b), std::max(a, b));
  }
}

std::vector<SurfacePoint> resolve(const RobotDescription& description, const std::vector<NamedPoint>& named) {
  std::vector<SurfacePoint> points;
  for (const NamedPoint& point : named) {
    points.push_back(point.point);
    points.back().link = require_link(description, point.link);
  }
  return points;
}

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
}

Eigen::VectorXd read_weights(const YamlValue& file, const RobotDescription& description) {
  std::vector<std::string> names = description.arm_joints;
  names.insert(names.end(), description.hand_joints.begin(), description.hand_joints.end());
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(names.size()));
  const std::optional<YamlValue> given = file.find("weights");
  if (!given) return weights;
  for (const auto& [name, value] : given->entries()) {
    const auto joint = std::find(names.begin(), names.end(), name);
    if (joint == names.end()) value.fail("no such arm or hand joint");
    const double weight = value.number();
    if (weight <= 0.0) value.fail("expected a positive number, found '" + value.text() + "'");
    weights[joint - names.begin()] = weight;
  }
  return weights;
}

struct RobotFile {
  YamlValue file;
  YamlValue arm;
  HandFile hand;
  std::vector<NamedValue> without_geometry;  ///< of both files
  UrdfSettings settings;                     ///< of the arm; the hand's own packages are added for a joined URDF
};

/// One URDF holds arm and hand: the palm's parent is the tip of the arm.
RobotDescription load_joined(const RobotFile& robot, const std::filesystem::path& urdf) {
  UrdfSettings settings = robot.settings;
  const PackagePaths& more = robot.hand.urdf_settings.packages;
  settings.packages.directories.insert(more.directories.begin(), more.directories.end());
  settings.packages.roots.insert(settings.packages.roots.end(), more.roots.begin(), more.roots.end());
  RobotDescription description = read_urdf(urdf, settings);
  require_links(robot.without_geometry, description, description);
  const int palm = require_link(description, robot.hand.palm_link);
  const int joint = description.links[static_cast<std::size_t>(palm)].joint;
  if (joint < 0) robot.hand.palm_link.where.fail("'" + robot.hand.palm_link.name + "' is the root: no arm carries it");
  const int parent = description.joints[static_cast<std::size_t>(joint)].parent;
  description.arm_tip_link = description.links[static_cast<std::size_t>(parent)].name;
  return description;
}

RobotDescription load_mounted(const RobotFile& robot, const std::filesystem::path& urdf, const YamlValue& mount) {
  mount.allow_keys({"parent", "xyz", "rpy", "support"});
  RobotDescription description = read_urdf(urdf, robot.settings);
  const NamedValue parent_name = {mount.at("parent").text(), mount.at("parent")};
  const int parent = require_link(description, parent_name);
  description.arm_tip_link = parent_name.name;
  if (const auto support = mount.find("support")) attach_support(description, parent, *support);
  UrdfSettings hand_settings = robot.hand.urdf_settings;
  hand_settings.geometry = robot.settings.geometry;
  const RobotDescription hand = read_urdf(robot.hand.urdf.path(), hand_settings);
  require_links(robot.without_geometry, description, hand);
  attach(description, subtree(hand, require_link(hand, robot.hand.palm_link)), parent, mount.pose(), mount);
  return description;
}

void add_mesh_files(RobotDescription& description) {
  for (const Link& link : description.links) append_mesh_files(link.collision, description.files);
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error);
}

}  // namespace

RobotDescription load_hand(const std::filesystem::path& hand_yaml) {
  return load_hand(hand_yaml, read_hand_file(hand_yaml).urdf.path());
}

RobotDescription load_hand(const std::filesystem::path& hand_yaml, const std::filesystem::path& urdf) {
  const HandFile hand = read_hand_file(hand_yaml);
  const RobotDescription whole = read_urdf(urdf, hand.urdf_settings);
  require_links(hand.without_geometry, whole, whole);
  RobotDescription description = subtree(whole, require_link(whole, hand.palm_link));
  fill_hand(description, hand);
  description.weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(description.hand_joints.size()));
  description.files = {hand_yaml, urdf};
  add_mesh_files(description);
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

RobotDescription load_robot(const std::filesystem::path& robot_yaml) { return load_robot(robot_yaml, ""); }

RobotDescription load_robot(const std::filesystem::path& robot_yaml, const std::string& group) {
  const YamlValue file = YamlValue::load(robot_yaml);
  if (file.has("arms")) return load_arms(file, group);
  if (!group.empty()) file.fail("has one arm and no key 'arms', so there is no arm '" + group + "' to choose");
  file.allow_keys({"name", "arm", "hand", "mount", "collision", "without_geometry", "weights", "allowed_collisions"});
  return load_arm(file, read_link_geometry(file));
}

RobotDescription load_arm(const YamlValue& file, LinkGeometry geometry) {
  const YamlValue arm = file.at("arm");
  arm.allow_keys({"urdf", "packages", "joints"});
  RobotFile robot{file, arm, read_hand_file(file.at("hand").path()), {}, {}};
  robot.settings = {read_packages(arm), geometry, robot.hand.urdf_settings.without_geometry};
  robot.without_geometry = read_without_geometry(file, robot.settings);
  for (const NamedValue& link : robot.hand.without_geometry) robot.without_geometry.push_back(link);
  robot.hand.urdf_settings.without_geometry = robot.settings.without_geometry;
  const std::filesystem::path urdf = arm.at("urdf").path();
  const std::optional<YamlValue> mount = file.find("mount");
  if (!mount && !same_file(urdf, robot.hand.urdf.path())) {
    file.fail("needs a key 'mount', since arm.urdf and the hand's urdf are two files");
  }
  RobotDescription description = mount ? load_mounted(robot, urdf, *mount) : load_joined(robot, urdf);
  if (const auto name = file.find("name")) description.name = name->text();
  for (const NamedValue& joint : read_names(arm.at("joints"))) {
    require_actuated(description, joint);
    description.arm_joints.push_back(joint.name);
  }
  if (description.arm_joints.empty()) arm.at("joints").fail("names no joint");
  fill_hand(description, robot.hand);
  for (const NamedValue& joint : robot.hand.joints) {
    const auto& names = description.arm_joints;
    if (std::find(names.begin(), names.end(), joint.name) != names.end()) {
      joint.where.fail("joint '" + joint.name + "' is also an arm joint");
    }
  }
  allow_pairs(description, read_pairs(file));
  description.weights = read_weights(file, description);
  description.files = {file.file(), file.at("hand").path(), urdf};
  if (mount) description.files.push_back(robot.hand.urdf.path());
  add_mesh_files(description);
  return description;
}

}  // namespace opponens::robot
