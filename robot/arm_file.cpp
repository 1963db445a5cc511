// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/arm_file.hpp"

#include <algorithm>

#include "robot/hand_file.hpp"
#include "robot/link_pairs.hpp"
#include "robot/named_links.hpp"
#include "robot/tree.hpp"

namespace opponens::robot {

namespace {

/// Appends the hand's tree to a link of the arm.
void attach(RobotDescription& robot, const RobotDescription& hand, int parent, const Eigen::Isometry3d& X_PH,
            const YamlValue& where) {
  for (const Joint& joint : hand.joints) {
    const bool repeats = std::any_of(robot.joints.begin(), robot.joints.end(),
                                     [&](const Joint& other) { return other.name == joint.name; });
    if (repeats) where.fail("arm and hand both have a joint '" + joint.name + "'");
  }
  for (const Link& link : hand.links) {
    if (find_link(robot, link.name)) {
      where.fail("arm and hand both have a link '" + link.name + "'; the key arm.link_prefix tells them apart");
    }
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

/// Key accelerations: limits by joint name, rad/s^2 or m/s^2; a URDF has none.
void read_accelerations(const YamlValue& file, RobotDescription& description) {
  const std::optional<YamlValue> given = file.find("accelerations");
  if (!given) return;
  std::vector<std::string> names = description.arm_joints;
  names.insert(names.end(), description.hand_joints.begin(), description.hand_joints.end());
  for (const auto& [name, value] : given->entries()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) value.fail("no such arm or hand joint");
    const double limit = value.number();
    if (limit <= 0.0) value.fail("expected a positive number, found '" + value.text() + "'");
    std::find_if(description.joints.begin(), description.joints.end(), [&name = name](const Joint& joint) {
      return joint.name == name;
    })->acceleration = limit;
  }
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

/// Key arm.link_prefix, put before the names of the arm's links: arm and hand often both have a 'base_link'. Names in
/// robot.yaml carry it, so the URDF is asked to leave out the shapes of its own names.
RobotDescription load_arm_urdf(const RobotFile& robot, const std::filesystem::path& urdf) {
  const std::optional<YamlValue> prefix = robot.arm.find("link_prefix");
  if (!prefix) return read_urdf(urdf, robot.settings);
  const std::string text = prefix->text();
  UrdfSettings settings = robot.settings;
  settings.without_geometry.clear();
  for (const std::string& name : robot.settings.without_geometry) {
    if (name.starts_with(text)) settings.without_geometry.insert(name.substr(text.size()));
  }
  RobotDescription description = read_urdf(urdf, settings);
  for (Link& link : description.links) link.name = text + link.name;
  for (MissingMesh& missing : description.missing_meshes) missing.link = text + missing.link;
  return description;
}

RobotDescription load_mounted(const RobotFile& robot, const std::filesystem::path& urdf, const YamlValue& mount) {
  mount.allow_keys({"parent", "xyz", "rpy", "support"});
  RobotDescription description = load_arm_urdf(robot, urdf);
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

void name_arm(const YamlValue& file, const YamlValue& arm, RobotDescription& description) {
  if (const auto name = file.find("name")) description.name = name->text();
  for (const NamedValue& joint : read_names(arm.at("joints"))) {
    require_actuated(description, joint);
    description.arm_joints.push_back(joint.name);
  }
  if (description.arm_joints.empty()) arm.at("joints").fail("names no joint");
}

/// A robot.yaml without the key hand.
RobotDescription load_arm_alone(const YamlValue& file, const YamlValue& arm, const ArmSettings& arm_settings) {
  if (const auto mount = file.find("mount")) mount->fail("mounts a hand, but there is no key 'hand'");
  if (const auto prefix = arm.find("link_prefix")) prefix->fail("is for an arm and a hand in two files");
  UrdfSettings settings{read_packages(arm), arm_settings.geometry, {}, arm_settings.missing_meshes};
  const std::vector<NamedValue> without_geometry = read_without_geometry(file, settings);
  const std::filesystem::path urdf = arm.at("urdf").path();
  RobotDescription description = read_urdf(urdf, settings);
  require_links(without_geometry, description, description);
  name_arm(file, arm, description);
  allow_adjacent(description);
  allow_pairs(description, read_pairs(file));
  if (const auto srdf = read_srdf_path(file)) apply_srdf(read_srdf(*srdf), description);
  description.weights = read_weights(file, description);
  read_accelerations(file, description);
  description.files = {file.file(), urdf};
  add_files_inside(description);
  return description;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error);
}

}  // namespace

RobotDescription load_arm(const YamlValue& file, const ArmSettings& settings) {
  const YamlValue arm = file.at("arm");
  arm.allow_keys({"urdf", "packages", "joints", "link_prefix"});
  if (!file.has("hand")) return load_arm_alone(file, arm, settings);
  RobotFile robot{file, arm, read_hand_file(file.at("hand").path()), {}, {}};
  robot.settings = {read_packages(arm), settings.geometry, robot.hand.urdf_settings.without_geometry,
                    settings.missing_meshes};
  robot.hand.urdf_settings.missing_meshes = settings.missing_meshes;
  robot.without_geometry = read_without_geometry(file, robot.settings);
  for (const NamedValue& link : robot.hand.without_geometry) robot.without_geometry.push_back(link);
  robot.hand.urdf_settings.without_geometry = robot.settings.without_geometry;
  const std::filesystem::path urdf = arm.at("urdf").path();
  const std::optional<YamlValue> mount = file.find("mount");
  if (!mount && arm.has("link_prefix")) arm.at("link_prefix").fail("is for an arm and a hand in two files");
  if (!mount && !same_file(urdf, robot.hand.urdf.path())) {
    file.fail("needs a key 'mount', since arm.urdf and the hand's urdf are two files");
  }
  RobotDescription description = mount ? load_mounted(robot, urdf, *mount) : load_joined(robot, urdf);
  name_arm(file, arm, description);
  fill_hand(description, robot.hand);
  for (const NamedValue& joint : robot.hand.joints) {
    const auto& names = description.arm_joints;
    if (std::find(names.begin(), names.end(), joint.name) != names.end()) {
      joint.where.fail("joint '" + joint.name + "' is also an arm joint");
    }
  }
  allow_pairs(description, read_pairs(file));
  if (const auto srdf = read_srdf_path(file)) apply_srdf(read_srdf(*srdf), description);
  description.weights = read_weights(file, description);
  read_accelerations(file, description);
  description.files = {file.file(), file.at("hand").path(), urdf};
  if (mount) description.files.push_back(robot.hand.urdf.path());
  add_files_inside(description);
  return description;
}

}  // namespace opponens::robot
