// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/geometry.hpp"

namespace simulated_postures {

/// A segment of a finger: all points within radius of the line from a to b, in its link's frame, m.
struct Capsule {
  int link = -1;
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double radius = 0.0;
};

/// Signed distance of a capsule to a shape: along the capsule's line the distance to a convex shape is a convex
/// function, so its least value is found by ternary search, to 1e-7 m. Boxes, spheres and cylinders are exact.
double signed_distance(const opponens::robot::Geometry& body, const Eigen::Isometry3d& X_WB, const Capsule& capsule,
                       const Eigen::Isometry3d& X_WL);

/// Gap between two capsules in poses of a common frame; negative when they overlap. m.
double gap(const Capsule& first, const Eigen::Isometry3d& X_W1, const Capsule& second, const Eigen::Isometry3d& X_W2);

}  // namespace simulated_postures
