// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A grasp without a store: a hand from a hand.yaml, a ball, synergies given by hand (all fingers flex together, the
// thumb opposes), and the force-closure grasps found along them. Usage: example_02_grasp MODELS_FOLDER
#include <algorithm>
#include <cstdio>

#include "grasp/grasp_search.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"

namespace {

using namespace opponens;

robot::Scene ball_in_the_air(double radius) {
  robot::Scene scene;
  scene.name = "a ball in the air";
  scene.object = "ball";
  robot::SceneBody ball;
  ball.name = "ball";
  ball.geometry = {{robot::Sphere{radius}}};
  scene.bodies = {ball};
  return scene;
}

/// A box of two synergies around a half-closed hand.
SynergyGroup whole_hand(const robot::RobotModel& hand) {
  const int n = hand.dof();
  SynergyGroup group;
  group.name = "whole hand";
  group.phase = "grasp";
  group.box.center = hand.clip(0.6 * Eigen::VectorXd::Ones(n));
  group.box.scale = Eigen::VectorXd::Ones(n);
  group.box.half_width = Eigen::Vector2d(1.5, 1.0);
  group.box.axes = Eigen::MatrixXd::Zero(n, 2);
  for (int i = 0; i < 12; ++i)
    group.box.axes(i, 0) = i % 4 == 0 ? 0.0 : 1.0;          // three fingers: abduction, then flexions
  for (int i = 12; i < n; ++i) group.box.axes(i, 1) = 1.0;  // thumb
  group.box.axes.colwise().normalize();
  group.box.center = group.box.center.unaryExpr([](double q) { return std::max(q, 0.1); });
  for (int i = 0; i < 12; i += 4) group.box.center(i) = 0.0;
  group.box.center(12) = 1.3;
  group.basis.mean = group.box.center;
  group.basis.axes = Eigen::MatrixXd::Identity(n, n);
  group.basis.variance = Eigen::VectorXd::Ones(n);
  group.dof_effective = n;
  return group;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::printf("usage: %s MODELS_FOLDER\n", argv[0]), 2;
  const robot::RobotModel hand(robot::load_hand(std::string(argv[1]) + "/ur5_allegro/allegro_right.yaml"));
  const robot::Scene scene = ball_in_the_air(0.035);
  const SynergyGroup group = whole_hand(hand);

  grasp::SearchSettings settings;
  settings.count = 3;
  settings.max_trials = 300;
  const auto result = grasp::search_grasps(hand, scene, "ball", group, group.box, settings, /*seed=*/1);
  std::printf("%lld trials, %zu grasps\n", static_cast<long long>(result.trials), result.grasps.size());
  for (const auto& [reason, count] : result.rejected) {
    std::printf("  %4lld x %s\n", static_cast<long long>(count), reason.c_str());
  }
  for (const auto& found : result.grasps) {
    std::printf("epsilon %.4f, l* %.5f, %zu contacts:", found.quality.epsilon.value_or(-1.0),
                found.quality.min_weight.value_or(0.0), found.contacts.size());
    for (const auto& contact : found.contacts) std::printf(" %s", contact.link.c_str());
    std::printf("\n");
  }
  return result.grasps.empty() ? 1 : 0;
}
