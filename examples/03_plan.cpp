// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A path without a store: the UR5 + Allegro in front of a shelf, one goal configuration, and boxes around the two hand
// postures in the place of learnt synergies. Usage: example_03_plan MODELS_FOLDER
#include <cstdio>

#include "motion/edge_check.hpp"
#include "motion/shortcut.hpp"
#include "motion/syn_planner.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"
#include "robot/scene.hpp"

namespace {

using namespace opponens;

Eigen::VectorXd start_of(const robot::RobotModel& robot, const robot::Scene& scene) {
  Eigen::VectorXd q(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) {
    for (std::size_t j = 0; j < scene.start_joints.size(); ++j) {
      if (scene.start_joints[j] == robot.joint_names()[static_cast<std::size_t>(i)])
        q(i) = scene.start(static_cast<int>(j));
    }
  }
  return q;
}

/// Two synergies, the flexion of the fingers and of the thumb, around a posture.
SynergyBox box_around(const Eigen::VectorXd& q_hand) {
  SynergyBox box;
  box.center = q_hand;
  box.scale = Eigen::VectorXd::Ones(q_hand.size());
  box.axes = Eigen::MatrixXd::Zero(q_hand.size(), 2);
  for (int i = 0; i < 12; ++i) box.axes(i, 0) = i % 4 == 0 ? 0.0 : 1.0;
  for (int i = 13; i < 16; ++i) box.axes(i, 1) = 1.0;
  box.axes.colwise().normalize();
  box.half_width = Eigen::Vector2d(0.8, 0.5);
  return box;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::printf("usage: %s MODELS_FOLDER\n", argv[0]), 2;
  const std::string models = argv[1];
  const robot::RobotModel robot(robot::load_robot(models + "/ur5_allegro/ur5_allegro_right.yaml"));
  const robot::Scene scene = robot::load_scene(models + "/scenes/bottle_shelf.yaml");
  const robot::CollisionChecker checker(robot, scene);

  const Eigen::VectorXd start = start_of(robot, scene);
  Eigen::VectorXd goal = start;  // the arm swung to the other side, the hand a little more closed
  goal(0) += 1.5;
  goal.tail(16).array() += 0.2;
  const auto& hand = robot.hand();
  const SynergyBox pre_grasp = box_around(start.segment(hand.first, hand.count));
  const SynergyBox grasp = box_around(goal.segment(hand.first, hand.count));

  motion::PlannerSettings settings;
  const motion::World world = motion::make_world(checker, robot, 0.02);
  const PlanResult result = motion::plan(start, pre_grasp, {{goal, grasp, 0}}, robot.joint_names(), hand, robot.lower(),
                                         robot.upper(), robot.weights(), world, settings, /*seed=*/1);
  if (result.status != PlanStatus::solved) return std::printf("no path: %s\n", result.detail.c_str()), 1;
  const auto shorter = motion::shortcut(result.path, robot.weights(), world, {}, /*seed=*/1);
  std::printf("%lld iterations, %lld collision checks; %.2f rad, shortened to %.2f rad, %ld waypoints\n",
              static_cast<long long>(result.iterations), static_cast<long long>(result.collision_checks), result.length,
              shorter.length, static_cast<long>(shorter.path.waypoints.rows()));
  return 0;
}
