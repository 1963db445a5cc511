// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "core/synergies.hpp"
#include "motion/contact_depth.hpp"
#include "robot/collision.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::cli {

/// A driven arm's part: its hand, and what that grasps.
struct GraspingArm {
  std::string name;        ///< empty: the robot has one arm
  robot::RobotModel hand;  ///< the tree below the palm
  std::string object;      ///< body of the scene
};

/// A robot, a scene and the objects to grasp, as the user named them.
struct NamedWorld {
  robot::RobotModel robot;
  std::vector<GraspingArm> arms;  ///< as RobotModel::arms()
  robot::Scene scene;
  Json parameters;                           ///< what ties stored objects to this world
  std::vector<std::filesystem::path> files;  ///< hashed into the provenance

  // Of a world where one arm is driven. They throw std::invalid_argument when several are.
  const robot::RobotModel& hand() const { return one_arm().hand; }
  const std::string& object() const { return one_arm().object; }
  Eigen::Isometry3d X_RO() const { return scene.X_WR.inverse() * scene.body(object()).X_WB; }

  /// Of what one arm does in this world.
  WorldKey key(const GraspingArm& arm) const;
  /// Each hand's links with its own object: what may touch while it closes.
  std::vector<motion::TouchingLinks> touching() const;
  std::vector<robot::BodyPair> hand_object_pairs() const;

  const GraspingArm& one_arm() const;
};

/// Loads a hand.yaml as find_file finds it; urdf in place of the one it names, unless empty.
robot::RobotDescription load_hand_file(const std::string& hand, const std::string& urdf);
/// The robot hand that a mapped recording is about.
robot::RobotDescription hand_of_motion(const storage::Record& record);

/// Loads them. objects: as --object names them (cli/object_choice.hpp). Throws InputError in one sentence.
NamedWorld load_world(const std::string& robot_file, const std::string& scene_file,
                      const std::vector<std::string>& objects);
/// The world that a stored object was made with, by its parameter "world".
NamedWorld load_world(const Json& recorded);
/// Throws InputError unless one arm is driven.
void require_one_arm(const NamedWorld& world);
/// "FILE#ARM": the world's robot with another choice of the driven arm.
std::string file_with_arm(const NamedWorld& world, const std::string& arm);

/// What the user should know about the loaded files, a sentence each: what was ignored or assumed while loading, what
/// is wrong with the scene's meshes, and the open meshes, inside of which nothing counts as a collision.
std::vector<std::string> warnings_of(const robot::RobotModel& robot, const robot::Scene& scene,
                                     const robot::CollisionChecker& checker);
std::vector<std::string> warnings_of(const NamedWorld& world, const robot::CollisionChecker& checker);

/// Throws InputError unless the synergies are about this hand's joints, in its order.
void require_same_joints(const SynergySet& synergies, const robot::RobotModel& hand);

/// The scene's start configuration in the robot's joint order. Throws InputError when it has none, a joint is
/// missing, or it names one that the robot does not have.
Eigen::VectorXd start_configuration(const robot::RobotModel& robot, const robot::Scene& scene);

}  // namespace opponens::cli
