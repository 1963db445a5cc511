// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// A rigid body of the hand with its surface, in the palm frame, joints at rest.
struct HandBody {
  std::vector<int> links;
  std::vector<Geometry> geometry;  ///< of all links, fixed to the palm frame
  std::vector<int> owner;          ///< [geometry] link
  Eigen::Matrix3Xd vertices;       ///< [3 x V] m, of the triangulated surface
};

/// The body made of these links. X_PL: pose of each link of the robot in the palm frame.
HandBody hand_body(const RobotModel& robot, const std::vector<int>& links, const std::vector<Eigen::Isometry3d>& X_PL);

struct SurfaceHit {
  int link;
  double distance;         ///< m along the ray
  Eigen::Vector3d p;       ///< m, palm frame
  Eigen::Vector3d normal;  ///< unit, outward, palm frame
};

/// The outermost point of the body on the line through p along `outward` (unit): where a ray against it hits first.
std::optional<SurfaceHit> outermost(const HandBody& body, const Eigen::Vector3d& p, const Eigen::Vector3d& outward);

/// Least and largest coordinate of points [3 x N >= 1] along a direction.
Eigen::Vector2d extent_along(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction);

/// Those of the points whose coordinate along a direction lies within [from, to]; all of them when none does.
Eigen::Matrix3Xd slab(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction, double from, double to);

}  // namespace opponens::robot
