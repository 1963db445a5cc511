// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Robots made for the tests of the two-stage collision checker.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "experiments/collision_equality/made_meshes.hpp"
#include "robot/mesh.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

inline Shape mesh_of(TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); }

inline Eigen::Vector3d random_direction(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

inline Eigen::Isometry3d random_pose(double spread, Rng& rng) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() =
      Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized().toRotationMatrix();
  X.translation() = spread * Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
  return X;
}

/// Any kind of shape, `size` m across.
inline Shape random_shape(double size, Rng& rng) {
  const double a = size * rng.uniform(0.2, 1.0);
  switch (rng.index(5)) {
    case 0:
      return Box{{a, size * rng.uniform(0.1, 0.5), size * rng.uniform(0.1, 0.5)}};
    case 1:
      return Sphere{0.5 * a};
    case 2:
      return Cylinder{0.3 * a, size};
    case 3:
      return mesh_of(torus(0.4 * a, 0.1 * a, 16));
    default:
      return mesh_of(triangulate(Cylinder{0.3 * a, size}, 12));
  }
}

/// One of the axes, their opposites, nearly an opposite, or anything.
inline Eigen::Vector3d random_axis(Rng& rng) {
  const double sign = rng.index(2) == 0 ? 1.0 : -1.0;
  switch (rng.index(4)) {
    case 0:
      return {0.0, 0.0, sign};
    case 1:
      return {sign, 0.0, 0.0};
    case 2:
      return Eigen::Vector3d(1.6e-6, 0.0, sign).normalized();
    default:
      return random_direction(rng);
  }
}

/// A link for each joint and a root; neighbours may touch.
struct RobotBuilder {
  RobotDescription robot;

  explicit RobotBuilder(const std::vector<Geometry>& root) {
    robot.name = "made";
    robot.links.push_back({"link_0", -1, root});
    robot.palm_link = "link_0";
  }
  Joint& add(int parent, JointType type, const Eigen::Vector3d& axis, const Eigen::Isometry3d& X_PJ,
             const std::vector<Geometry>& geometry) {
    const int index = static_cast<int>(robot.joints.size());
    Joint joint;
    joint.name = "joint_" + std::to_string(index);
    joint.type = type;
    joint.parent = parent;
    joint.child = index + 1;
    joint.X_PJ = X_PJ;
    joint.axis = axis;
    joint.lower = type == JointType::prismatic ? -0.3 : -3.0;
    joint.upper = -joint.lower;
    joint.velocity = 1.0;
    robot.links.push_back({"link_" + std::to_string(index + 1), index, geometry});
    robot.allowed_collisions.insert({parent, index + 1});
    robot.joints.push_back(joint);
    return robot.joints.back();
  }
  RobotModel model() {
    robot.hand_joints.clear();
    for (const Joint& joint : robot.joints) {
      if (joint.type != JointType::fixed && !joint.mimic) robot.hand_joints.push_back(joint.name);
    }
    return RobotModel(robot);
  }
};

/// A tree with turning, sliding, fixed and mimicking joints about and along all sorts of axes.
inline RobotModel random_robot(int joints, double length, Rng& rng) {
  RobotBuilder builder({{random_shape(length, rng), random_pose(0.1 * length, rng)}});
  std::vector<std::string> sources;
  for (int i = 0; i < joints; ++i) {
    const int parent = std::max(0, i - static_cast<int>(rng.index(3)));
    const double kind = rng.uniform();
    const JointType type = kind < 0.6 ? JointType::revolute : kind < 0.85 ? JointType::prismatic : JointType::fixed;
    std::vector<Geometry> geometry;
    for (std::uint64_t g = rng.index(3); g > 0; --g) {
      geometry.push_back({random_shape(0.7 * length, rng), random_pose(0.3 * length, rng)});
    }
    Joint& joint = builder.add(parent, type, random_axis(rng), random_pose(length, rng), geometry);
    if (type == JointType::fixed) continue;
    if (!sources.empty() && rng.uniform() < 0.25) {
      joint.mimic = Mimic{sources[rng.index(sources.size())], rng.uniform(-2, 2), rng.uniform(-0.3, 0.3)};
      joint.lower = joint.upper = 0.0;  // none that could restrict the driver
    } else {
      sources.push_back(joint.name);
    }
  }
  return builder.model();
}

}  // namespace opponens::robot
