// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/world.hpp"

#include <algorithm>

#include "cli/object_choice.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "robot/cover_file.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh_check.hpp"
#include "robot/robot_arms.hpp"

namespace opponens::cli {
namespace {

/// The parameters by which grasps and paths find their robot, scene and objects again. The robot's arm, if it has
/// several, is named with its file: "FILE#ARM".
Json world_parameters(const NamedRobot& robot, const std::string& scene, const std::vector<GraspingArm>& arms) {
  const std::string arm = robot.arm.empty() ? "" : "#" + robot.arm;
  Json parameters = {{"robot", recorded_name(robot.file) + arm}, {"scene", recorded_name(find_file(scene))}};
  if (arms.size() == 1) parameters["object"] = arms[0].object;
  if (arms.size() > 1) {
    for (const GraspingArm& one : arms) parameters["objects"][one.name] = one.object;
  }
  return parameters;
}

}  // namespace

robot::RobotDescription load_hand_file(const std::string& hand, const std::string& urdf) {
  return urdf.empty() ? robot::load_hand(find_file(hand)) : robot::load_hand(find_file(hand), find_file(urdf));
}

robot::RobotDescription hand_of_motion(const storage::Record& record) {
  const Json parameters = parameters_of(record);
  return load_hand_file(parameters.at("hand"), parameters.value("urdf", ""));
}

NamedWorld load_world(const std::string& robot_file, const std::string& scene_file,
                      const std::vector<std::string>& objects) {
  NamedRobot named = named_robot(robot_file);
  const auto scene_path = find_file(scene_file);
  const std::filesystem::path covers = cover_folder();
  const robot::RobotDescription description = with_covers(robot::load_robot(named.file, named.arm), covers);
  const std::vector<std::string>& driven = description.driven_arms;
  if (!driven.empty()) named.arm = driven.size() == 1 ? driven[0] : robot::kBothArms;
  if (description.hand_joints.empty()) throw InputError(robot_file + ": is an arm without a hand: nothing can grasp");
  robot::Scene scene = with_covers(robot::load_scene(scene_path), covers);
  const std::vector<std::string> chosen = objects_of_arms(objects, driven, scene, scene_file);
  std::vector<GraspingArm> arms;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    arms.push_back(
        {driven.empty() ? "" : driven[i],
         robot::RobotModel(robot::hand_of(driven.size() > 1 ? drive_arms(description, driven[i]) : description)),
         chosen[i]});
  }
  std::vector<std::filesystem::path> files = description.files;
  files.insert(files.end(), scene.files.begin(), scene.files.end());
  Json parameters = world_parameters(named, scene_file, arms);
  return {robot::RobotModel(description), std::move(arms), std::move(scene), std::move(parameters), std::move(files)};
}

NamedWorld load_world(const Json& recorded) {
  return load_world(recorded.at("robot"), recorded.at("scene"), object_arguments(recorded));
}

std::string file_with_arm(const NamedWorld& world, const std::string& arm) {
  const auto robot = world.parameters.at("robot").get<std::string>();
  return robot.substr(0, robot.size() - recorded_arm(robot).size()) + arm;
}

void require_one_arm(const NamedWorld& world) {
  if (world.arms.size() == 1) return;
  throw InputError("--robot " + world.parameters.at("robot").get<std::string>() + ": a grasp is of one arm; name it: " +
                   file_with_arm(world, world.arms[0].name) + " or #" + world.arms[1].name);
}

const GraspingArm& NamedWorld::one_arm() const {
  require(arms.size() == 1, "this is about one arm, and several are driven");
  return arms[0];
}

WorldKey NamedWorld::key(const GraspingArm& arm) const {
  WorldKey key{arm.object, arm.name, {}};
  for (const auto& file : files) key.files.insert(file_sha256(file));
  return key;
}

std::vector<motion::TouchingLinks> NamedWorld::touching() const {
  std::vector<motion::TouchingLinks> hands;
  for (const GraspingArm& arm : arms) {
    hands.push_back({arm.object, {}});
    for (const auto& link : arm.hand.links()) hands.back().links.push_back(link.name);
  }
  return hands;
}

std::vector<robot::BodyPair> NamedWorld::hand_object_pairs() const {
  std::vector<robot::BodyPair> pairs;
  for (const motion::TouchingLinks& hand : touching()) {
    for (const std::string& link : hand.links) pairs.emplace_back(link, hand.object);
  }
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
