// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/world.hpp"

#include <algorithm>

#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "robot/cover_file.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh_check.hpp"

namespace opponens::cli {

robot::RobotDescription load_hand_file(const std::string& hand, const std::string& urdf) {
  return urdf.empty() ? robot::load_hand(find_file(hand)) : robot::load_hand(find_file(hand), find_file(urdf));
}

robot::RobotDescription hand_of_motion(const storage::Record& record) {
  const Json parameters = parameters_of(record);
  return load_hand_file(parameters.at("hand"), parameters.value("urdf", ""));
}

NamedWorld load_world(const std::string& robot_file, const std::string& scene_file, const std::string& object) {
  NamedRobot named = named_robot(robot_file);
  const auto scene_path = find_file(scene_file);
  const std::filesystem::path covers = cover_folder();
  robot::RobotDescription description = with_covers(robot::load_robot(named.file, named.arm), covers);
  if (description.driven_arms.size() > 1) {
    throw InputError("--robot " + robot_file + ": one arm grasps and moves; name it: " + named.file.string() + "#" +
                     description.driven_arms[0] + " or #" + description.driven_arms[1]);
  }
  if (!description.driven_arms.empty()) named.arm = description.driven_arms[0];
  if (description.hand_joints.empty()) throw InputError(robot_file + ": is an arm without a hand: nothing can grasp");
  robot::RobotDescription hand = robot::hand_of(description);
  robot::Scene scene = with_covers(robot::load_scene(scene_path), covers);
  const std::string name = object.empty() ? scene.object : object;
  if (name.empty()) throw InputError(scene_file + ": names no object to grasp; use --object");
  const bool known = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const robot::SceneBody& body) { return body.name == name; });
  if (!known) throw InputError("--object " + name + ": no such body in " + scene_file);
  std::vector<std::filesystem::path> files = description.files;
  files.insert(files.end(), scene.files.begin(), scene.files.end());
  return {robot::RobotModel(std::move(description)),
          robot::RobotModel(std::move(hand)),
          std::move(scene),
          name,
          world_parameters(named, scene_file, name),
          std::move(files)};
}

std::vector<std::string> NamedWorld::hand_links() const {
  std::vector<std::string> names;
  for (const auto& link : hand.links()) names.push_back(link.name);
  return names;
}

WorldKey NamedWorld::key() const {
  WorldKey key{object, recorded_arm(parameters.at("robot")), {}};
  for (const auto& file : files) key.files.insert(file_sha256(file));
  return key;
}

std::vector<robot::BodyPair> NamedWorld::hand_object_pairs() const {
  std::vector<robot::BodyPair> pairs;
  for (const auto& link : hand_links()) pairs.emplace_back(link, object);
  return pairs;
}

std::vector<std::string> warnings_of(const robot::RobotModel& robot, const robot::Scene& scene,
                                     const robot::CollisionChecker& checker) {
  std::vector<std::string> warnings = robot.description().notes;
  warnings.insert(warnings.end(), scene.notes.begin(), scene.notes.end());
  const std::vector<std::string> meshes = robot::mesh_warnings(scene);
  warnings.insert(warnings.end(), meshes.begin(), meshes.end());
  for (const auto& name : checker.open_meshes()) {
    warnings.push_back(name + ": its mesh is open, so it is a surface: nothing is seen to lie inside it");
  }
  return warnings;
}

std::vector<std::string> warnings_of(const NamedWorld& world, const robot::CollisionChecker& checker) {
  return warnings_of(world.robot, world.scene, checker);
}

void require_same_joints(const SynergySet& synergies, const robot::RobotModel& hand) {
  if (synergies.joint_names == hand.joint_names()) return;
  std::string expected;
  for (const auto& name : hand.joint_names()) expected += (expected.empty() ? "" : " ") + name;
  throw InputError("the newest synergies are about other joints than this hand's (" + expected +
                   "); run: opponens retarget --hand, then opponens analyze");
}

Eigen::VectorXd start_configuration(const robot::RobotModel& robot, const robot::Scene& scene) {
  // A scene's start may name joints that rest here, such as the other arm's; a name that no joint has is a mistake.
  for (const auto& name : scene.start_joints) {
    const auto& joints = robot.description().joints;
    if (std::none_of(joints.begin(), joints.end(), [&](const robot::Joint& joint) { return joint.name == name; })) {
      throw InputError(scene.name + ": the scene's start configuration names joint " + name +
                       ", which the robot does not have");
    }
  }
  Eigen::VectorXd q(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) {
    const auto& name = robot.joint_names()[static_cast<std::size_t>(i)];
    const auto found = std::find(scene.start_joints.begin(), scene.start_joints.end(), name);
    if (found == scene.start_joints.end()) {
      throw InputError(scene.name + ": the scene's start configuration lacks joint " + name);
    }
    q(i) = scene.start(found - scene.start_joints.begin());
  }
  return q;
}

}  // namespace opponens::cli
