// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>

#include <Eigen/Geometry>

#include "robot/narrow_phase.hpp"

namespace opponens::robot {

/// Whether a plane was found that keeps the convex hulls of two shapes at least `margin` (m) apart, by the steps of
/// Gilbert, Johnson and Keerthi (1988, doi:10.1109/56.2083) on the support points of their difference, 20 at most. Not
/// found does not mean that they meet. Boxes, cylinders and spheres are their own hulls.
bool convex_apart(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB, double margin);

enum class Convex { apart, overlapping, unknown };

/// A primitive, or the convex hull of points that are referred to.
using ConvexForm = std::variant<Box, Sphere, Cylinder, const HullVertices*>;
struct ConvexSolid {
  ConvexForm form;
  Eigen::Vector3d center;  ///< a point near its middle, m
};
/// Of a mesh its convex hull.
ConvexSolid convex_solid(const CollisionShape& shape);

/// The same, and with depth > 0 whether the hulls overlap for certain: a polytope of points of the difference came to
/// hold a ball of radius `depth` (m) about the origin.
Convex convex_relation(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB, double margin,
                       double depth);
Convex convex_relation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, double margin, double depth);

}  // namespace opponens::robot
