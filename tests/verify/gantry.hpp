// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "grasp/quality.hpp"
#include "robot/mesh.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::verify {

inline robot::Joint slide(const std::string& name, int parent, int child, const Eigen::Vector3d& axis,
                          const Eigen::Vector3d& at = Eigen::Vector3d::Zero()) {
  robot::Joint joint;
  joint.name = name;
  joint.type = robot::JointType::prismatic;
  joint.parent = parent;
  joint.child = child;
  joint.axis = axis;
  joint.X_PJ.translation() = at;
  joint.lower = -1.0;
  joint.upper = 1.0;
  joint.velocity = 1.0;
  return joint;
}

/// A ball of 5 cm that slides along x and y (the arm), with a smaller ball before it that slides along z (the hand).
inline robot::RobotModel gantry() {
  robot::RobotDescription d;
  d.name = "gantry";
  d.links = {{"base", -1, {}},
             {"carriage", 0, {}},
             {"palm", 1, {{robot::Sphere{0.05}, {}}}},
             {"finger", 2, {{robot::Sphere{0.01}, {}}}}};
  for (auto& link : d.links) {
    for (auto& geometry : link.collision) geometry.X_BG.setIdentity();
  }
  d.joints = {slide("x", 0, 1, Eigen::Vector3d::UnitX()), slide("y", 1, 2, Eigen::Vector3d::UnitY()),
              slide("f", 2, 3, Eigen::Vector3d::UnitZ(), {0.1, 0, 0})};
  d.arm_joints = {"x", "y"};
  d.hand_joints = {"f"};
  d.palm_link = "palm";
  d.arm_tip_link = "palm";
  d.weights = Eigen::Vector3d::Ones();
  d.allowed_collisions = {{0, 1}, {1, 2}, {2, 3}};
  return robot::RobotModel(d);
}

/// Two of them side by side, right at y = -0.5 and left at y = 0.5, driven at once: q = [x y of each; f of each].
inline robot::RobotModel two_gantries() {
  robot::RobotDescription d = gantry().description();
  robot::RobotDescription both;
  both.name = "two gantries";
  both.links = {{"root", -1, {}}};
  std::vector<std::string> hands;
  for (const auto& [arm, y] : {std::pair{std::string("right/"), -0.5}, {std::string("left/"), 0.5}}) {
    const int first = static_cast<int>(both.links.size());
    for (std::size_t i = 1; i < d.links.size(); ++i) {
      robot::Link link = d.links[i];
      link.name = arm + link.name;
      link.joint += first - 1;
      both.links.push_back(link);
      robot::Joint joint = d.joints[i - 1];
      joint.name = arm + joint.name;
      joint.parent = i == 1 ? 0 : joint.parent + first - 1;
      joint.child += first - 1;
      if (i == 1) joint.X_PJ.translation().y() = y;
      both.joints.push_back(joint);
    }
    both.arms.push_back({arm.substr(0, arm.size() - 1),
                         {arm + "x", arm + "y"},
                         {arm + "f"},
                         arm + "palm",
                         arm + "palm",
                         {},
                         {},
                         Eigen::Vector3d::Ones()});
    both.driven_arms.push_back(both.arms.back().name);
    both.allowed_collisions.insert({{0, first}, {first, first + 1}, {first + 1, first + 2}});
    both.arm_joints.insert(both.arm_joints.end(), {arm + "x", arm + "y"});
    both.hand_joints.push_back(arm + "f");
  }
  both.palm_link = "right/palm";
  both.arm_tip_link = "right/palm";
  both.weights = Eigen::VectorXd::Ones(6);
  return robot::RobotModel(both);
}

inline robot::SceneBody body(const std::string& name, const robot::Shape& shape, const Eigen::Vector3d& p) {
  robot::SceneBody result;
  result.name = name;
  result.X_WB.translation() = p;
  result.geometry.push_back({shape, Eigen::Isometry3d::Identity()});
  return result;
}

/// Four ball-tipped fingers that slide along +x, -x, +y, -y onto a cube of 40 mm held in the middle of the palm.
inline robot::RobotModel cube_hand() {
  robot::RobotDescription d;
  d.name = "cube_hand";
  d.links = {{"palm", -1, {}}};
  const std::vector<Eigen::Vector3d> axes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d& axis = axes[static_cast<std::size_t>(i)];
    d.joints.push_back(slide("f" + std::to_string(i), 0, i + 1, axis, {0, 0, i < 2 ? 0.008 : -0.008}));
    d.links.push_back({"tip" + std::to_string(i), i, {{robot::Sphere{0.005}, Eigen::Isometry3d::Identity()}}});
    d.hand_joints.push_back(d.joints.back().name);
    d.allowed_collisions.emplace(0, i + 1);
  }
  d.palm_link = "palm";
  d.weights = Eigen::Vector4d::Ones();
  return robot::RobotModel(d);
}

inline SynergyBox cube_box() {
  SynergyBox box;
  box.center = Eigen::Vector4d::Constant(-0.04);
  box.axes = Eigen::Vector4d::Constant(0.5);
  box.half_width = Eigen::VectorXd::Constant(1, 0.05);
  box.scale = Eigen::Vector4d::Ones();
  return box;
}

/// The cube held by all four tips, coordinate system O in its middle.
inline Grasp cube_grasp() {
  Grasp grasp;
  grasp.group = "cube";
  grasp.q_grasp = Eigen::Vector4d::Constant(-0.025);
  grasp.q_pregrasp = Eigen::Vector4d::Constant(-0.05);
  grasp.coefficients = Eigen::VectorXd::Constant(1, 0.03);
  grasp.slack = Eigen::Vector4d::Zero();
  const std::vector<Eigen::Vector3d> axes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    grasp.contacts.push_back(
        {"tip" + std::to_string(i), -0.02 * axes[i] + Eigen::Vector3d(0, 0, i < 2 ? 0.008 : -0.008), axes[i], 0.5});
  }
  QualityConvention convention;
  convention.rho = 0.035;
  grasp.quality = grasp::evaluate(grasp.contacts, convention);  // the other side's solvers
  return grasp;
}

}  // namespace opponens::verify
