// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/geometry.hpp"

namespace opponens::verify {

/// A triangulated solid for questions about points, by plain loops over its triangles: slow, and independent of the
/// trees that robot/ and grasp/ use.
class Solid {
 public:
  /// Primitives are triangulated (64 segments around).
  explicit Solid(const robot::Shape& shape);

  /// Whether p (m, in the geometry's frame) lies inside, by the signed crossings of a ray; false for open meshes.
  bool inside(const Eigen::Vector3d& p) const;
  /// m, to the surface.
  double distance(const Eigen::Vector3d& p) const;
  /// Depth of p inside, m; 0 outside.
  double depth(const Eigen::Vector3d& p) const { return inside(p) ? distance(p) : 0.0; }
  /// Smallest angle, rad, between a direction and the cone that the outward normals of the triangles within `reach` m
  /// of p span (at an edge every direction between its faces' normals is a surface normal); pi when no triangle is
  /// near.
  double normal_angle(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double reach) const;

  bool closed() const { return closed_; }
  const robot::TriangleMesh& mesh() const { return mesh_; }
  /// One vertex of each connected component.
  const Eigen::Matrix3Xd& component_points() const { return component_points_; }

 private:
  enum class Crossing { none, in, out, unclear };
  Crossing crossing(Eigen::Index triangle, const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const;
  double triangle_distance(Eigen::Index triangle, const Eigen::Vector3d& p) const;

  robot::TriangleMesh mesh_;
  bool closed_;
  Eigen::AlignedBox3d bounds_;
  Eigen::Matrix3Xd component_points_;
};

}  // namespace opponens::verify
