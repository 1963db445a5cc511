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

/// A triangle, m.
struct Facet {
  Eigen::Vector3d a, b, c;
};

/// A primitive, a triangle, or the convex hull of points that are referred to.
using ConvexForm = std::variant<Box, Sphere, Cylinder, Facet, const HullVertices*>;
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

/// The distance of two convex solids by the same steps, within 1e-6 m, or as far as it takes to tell that it is at
/// least `enough` or below `needed` (m, needed <= enough). away: a direction in A's frame, of any length, from B to A,
/// to try first (zero: that between the centers); set to the last one tried. A good one settles it in one step.
GapBounds convex_gap(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB, double needed,
                     double enough, Eigen::Vector3d& away);

}  // namespace opponens::robot
