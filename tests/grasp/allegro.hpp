// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/synergies.hpp"
#include "robot/load_robot.hpp"
#include "robot/scene.hpp"

namespace opponens::test {

inline const robot::RobotModel& allegro() {
  static const robot::RobotModel hand(
      robot::load_hand(std::filesystem::path(OPPONENS_SOURCE_DIR) / "models/ur5_allegro/allegro_right.yaml"));
  return hand;
}

inline SynergyBox box(const Eigen::VectorXd& center, const Eigen::MatrixXd& axes, const Eigen::VectorXd& half_width) {
  SynergyBox result;
  result.center = center;
  result.axes = axes;
  result.half_width = half_width;
  result.scale = Eigen::VectorXd::Ones(center.size());
  return result;
}

/// Synthetic synergies of a power grasp: closing, spreading, and bending the finger bases against their tips.
struct Synergies {
  SynergyGroup group;
  SynergyBox pre_grasp;
};

inline Synergies power_synergies() {
  Eigen::VectorXd open(16);
  Eigen::VectorXd closed(16);
  open << 0, .1, .1, .1, 0, .1, .1, .1, 0, .1, .1, .1, 1.2, .2, .1, .1;
  closed << 0, .9, .8, .6, 0, .9, .8, .6, 0, .9, .8, .6, 1.3, .4, .5, .6;
  Eigen::MatrixXd axes = Eigen::MatrixXd::Zero(16, 3);
  axes.col(0) = (closed - open).normalized();
  axes(0, 1) = -1.0;
  axes(8, 1) = axes(12, 1) = 1.0;
  for (const int finger : {0, 4, 8}) {
    axes(finger + 1, 2) = 1.0;
    axes(finger + 2, 2) = -1.0;
  }
  for (int i = 1; i < 3; ++i) {  // Gram and Schmidt
    for (int j = 0; j < i; ++j) axes.col(i) -= axes.col(j).dot(axes.col(i)) * axes.col(j);
    axes.col(i).normalize();
  }
  Synergies synergies;
  synergies.group.name = "power";
  synergies.group.phase = "grasp";
  synergies.group.box = box(0.15 * open + 0.85 * closed, axes, Eigen::Vector3d(0.6, 0.3, 0.5));
  synergies.pre_grasp = box(open, axes, Eigen::Vector3d(0.5, 0.3, 0.3));
  return synergies;
}

/// One object named "object" at the world's origin; a table under it when table_z is given (its upper face).
inline robot::Scene scene_of(const robot::Shape& shape) {
  robot::Scene scene;
  scene.name = "test";
  scene.object = "object";
  scene.bodies.push_back({"object", Eigen::Isometry3d::Identity(), {{shape, Eigen::Isometry3d::Identity()}}});
  return scene;
}

inline robot::Scene with_table(robot::Scene scene, double table_z) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.translation().z() = table_z - 0.02;
  const robot::Shape slab = robot::Box{Eigen::Vector3d(1.0, 1.0, 0.04)};
  scene.bodies.push_back({"table", X_WB, {{slab, Eigen::Isometry3d::Identity()}}});
  scene.support = "table";
  return scene;
}

}  // namespace opponens::test
