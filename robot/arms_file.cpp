// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/arms_file.hpp"

#include <algorithm>
#include <map>
#include <memory>

#include "robot/arm_file.hpp"
#include "robot/hand_file.hpp"
#include "robot/link_pairs.hpp"
#include "robot/mesh.hpp"
#include "robot/robot_arms.hpp"
#include "robot/tree.hpp"

namespace opponens::robot {

namespace {

const char* const kRoot = "root";
const char* const kStand = "stand";

void append_stand(RobotDescription& robot, const YamlValue& stand, const ArmSettings& settings) {
  stand.allow_keys({"urdf", "packages", "xyz", "rpy"});
  const std::filesystem::path urdf = stand.at("urdf").path();
  RobotDescription tree = read_urdf(urdf, {read_packages(stand), settings.geometry, {}, settings.missing_meshes});
  robot.files.push_back(urdf);
  for (const Link& link : tree.links) append_mesh_files(link.collision, robot.files);
  add_prefix(tree, kStand);
  append_tree(robot, tree, 0, stand.pose(), kStand);
}

/// "right/tool0" in a file with several arms, also of the stand and the root.
int find_prefixed(const RobotDescription& robot, const NamedValue& link) {
  const std::optional<int> index = find_link(robot, link.name);
  if (!index) {
    link.where.fail("no link '" + link.name + "'; links are named '" + kRoot + "', '" + kStand +
                    "/LINK' or 'ARM/LINK' here");
  }
  return *index;
}

int base_link(const RobotDescription& robot, const YamlValue& base) {
  const std::optional<YamlValue> parent = base.find("parent");
  return parent ? find_prefixed(robot, {parent->text(), *parent}) : 0;
}

/// Rest positions by the names that the arm's own files use.
void read_rest(RobotDescription& arm, const YamlValue& rest) {
  std::vector<std::string> names = arm.arm_joints;
  names.insert(names.end(), arm.hand_joints.begin(), arm.hand_joints.end());
  for (const auto& [name, value] : rest.entries()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) value.fail("no such arm or hand joint");
    const auto joint = std::find_if(arm.joints.begin(), arm.joints.end(),
                                    [&name = name](const Joint& candidate) { return candidate.name == name; });
    const double position = value.number();
    if (position < joint->lower || position > joint->upper) {
      value.fail("expected a position from " + std::to_string(joint->lower) + " to " + std::to_string(joint->upper) +
                 ", found '" + value.text() + "'");
    }
    joint->rest = position;
  }
}

void check_name(const std::string& name, const YamlValue& entry) {
  if (name.empty() || name.find_first_of("/#") != std::string::npos) {
    entry.fail("an arm's name must not be empty and holds neither / nor #");
  }
  if (name == kStand || name == kRoot || name == kBothArms) entry.fail("an arm cannot be called '" + name + "'");
}

void append_arm(RobotDescription& robot, const std::string& name, const YamlValue& entry, const ArmSettings& settings) {
  check_name(name, entry);
  entry.allow_keys({"arm", "hand", "mount", "base", "rest", "without_geometry", "weights", "accelerations",
                    "allowed_collisions", "srdf"});
  RobotDescription arm = load_arm(entry, settings);
  if (const auto rest = entry.find("rest")) read_rest(arm, *rest);
  const std::optional<YamlValue> base = entry.find("base");
  if (base) base->allow_keys({"parent", "xyz", "rpy"});
  add_prefix(arm, name);
  const int parent = base ? base_link(robot, *base) : 0;
  const int offset =
      append_tree(robot, arm, parent, base ? base->pose() : Eigen::Isometry3d::Identity(), prefixed(name, "base"));
  for (auto* points : {&arm.tips, &arm.contact_points}) {
    for (SurfacePoint& point : *points) point.link += offset;
  }
  robot.arms.push_back({name, arm.arm_joints, arm.hand_joints, arm.palm_link, arm.arm_tip_link, arm.tips,
                        arm.contact_points, arm.weights});
  robot.files.insert(robot.files.end(), arm.files.begin(), arm.files.end());
}

/// Two arms of one make read the same mesh files: one copy serves both, also in what is built from it.
void share_meshes(RobotDescription& robot) {
  using Mesh = std::shared_ptr<const TriangleMesh>;
  std::multimap<std::filesystem::path, Mesh> known;
  for (Link& link : robot.links) {
    for (Geometry& geometry : link.collision) {
      auto* mesh = std::get_if<Mesh>(&geometry.shape);
      if (mesh == nullptr || (*mesh)->file.empty()) continue;
      const auto [first, last] = known.equal_range((*mesh)->file);
      const auto same = std::find_if(first, last, [&](const auto& entry) {
        return entry.second == *mesh ||
               (entry.second->vertices == (*mesh)->vertices && entry.second->triangles == (*mesh)->triangles);
      });
      if (same == last) {
        known.emplace((*mesh)->file, *mesh);
      } else {
        *mesh = same->second;
      }
    }
  }
}

/// Keeps the first of equal ones, in order.
template <typename T>
void remove_repeats(std::vector<T>& values) {
  std::vector<T> once;
  for (T& value : values) {
    if (std::find(once.begin(), once.end(), value) == once.end()) once.push_back(std::move(value));
  }
  values = std::move(once);
}

std::string chosen_group(const RobotDescription& robot, const YamlValue& file, const std::string& group) {
  const std::vector<std::string> choices = arm_choices(robot);
  std::string list;
  for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
  const auto is_choice = [&](const std::string& name) {
    return std::find(choices.begin(), choices.end(), name) != choices.end();
  };
  const std::optional<YamlValue> given = file.find("default");
  if (given && !is_choice(given->text())) given->fail("expected one of " + list + ", found '" + given->text() + "'");
  if (group.empty()) return given ? given->text() : choices[0];
  if (!is_choice(group)) file.at("arms").fail("no arm '" + group + "' to choose, expected one of " + list);
  return group;
}

}  // namespace

RobotDescription load_arms(const YamlValue& file, const std::string& group, MissingMeshes missing) {
  file.allow_keys({"name", "arms", "stand", "default", "collision", "allowed_collisions"});
  const ArmSettings settings{read_link_geometry(file), missing};
  RobotDescription robot;
  const std::optional<YamlValue> name = file.find("name");
  robot.name = name ? name->text() : file.file().stem().string();
  robot.files = {file.file()};
  robot.links.push_back({kRoot, -1, {}});
  if (const auto stand = file.find("stand")) append_stand(robot, *stand, settings);
  for (const auto& [arm, entry] : file.at("arms").entries()) append_arm(robot, arm, entry, settings);
  if (robot.arms.empty()) file.at("arms").fail("names no arm");
  allow_adjacent(robot);
  for (const auto& [first, second] : read_pairs(file)) {
    const int a = find_prefixed(robot, first);
    const int b = find_prefixed(robot, second);
    robot.allowed_collisions.emplace(std::min(a, b), std::max(a, b));
  }
  share_meshes(robot);
  remove_repeats(robot.files);
  remove_repeats(robot.notes);
  return drive_arms(robot, chosen_group(robot, file, group));
}

}  // namespace opponens::robot
