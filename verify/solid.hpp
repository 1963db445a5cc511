// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/geometry.hpp"
#include "verify/ball_tree.hpp"

namespace opponens::verify {

/// A shape as triangles around it: boxes and meshes exactly, spheres and cylinders by a polyhedron whose faces touch
/// them from outside, with as many segments as keep it within `tolerance` m of them. So distances between two such
/// surfaces are never larger than those of the shapes.
robot::TriangleMesh circumscribed(const robot::Shape& shape, double tolerance = 2e-5);

/// A triangulated solid for questions about points, on verify's own ball tree. Immutable, thread-safe.
class Solid {
 public:
  /// Primitives are circumscribed.
  explicit Solid(const robot::Shape& shape);

  /// Whether p (m, in the geometry's frame) lies inside, by the signed crossings of a ray; false for open meshes.
  bool inside(const Eigen::Vector3d& p) const;
  /// m, to the surface; `bound` when nothing is nearer than that.
  double distance(const Eigen::Vector3d& p, double bound = std::numeric_limits<double>::infinity()) const {
    return tree_.distance(p, bound);
  }
  /// Smallest angle, rad, between a direction and the cone that the outward normals of the triangles within `reach` m
  /// of p span (at an edge every direction between its faces' normals is a surface normal); pi when no triangle is
  /// near.
  double normal_angle(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double reach) const;

  bool closed() const { return closed_; }
  const robot::TriangleMesh& mesh() const { return *mesh_; }
  const BallTree& tree() const { return tree_; }
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  /// One vertex of each connected component.
  const Eigen::Matrix3Xd& component_points() const { return component_points_; }

 private:
  enum class Crossing { none, in, out, unclear };
  Crossing crossing(int triangle, const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const;
  /// Crossings in less crossings out along a ray; nothing when it grazes an edge.
  std::optional<int> winding(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const;

  std::shared_ptr<const robot::TriangleMesh> mesh_;
  BallTree tree_;
  bool closed_;
  Eigen::AlignedBox3d bounds_;
  Eigen::Matrix3Xd component_points_;
};

}  // namespace opponens::verify
