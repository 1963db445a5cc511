// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: the triangles of a mesh in the leaves of its cover.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/geometry.hpp"
#include "robot/sphere_tree.hpp"

namespace opponens::robot {

struct BoxedTriangle {
  Eigen::Matrix3d corners;  ///< m, columns
  Eigen::AlignedBox3d box;
};

/// Those whose boxes reach into a ball, in ascending order.
std::vector<Eigen::Index> triangles_near(const TriangleMesh& mesh, const SphereTree::Node& ball);

/// Of each leaf all triangles_near its ball, hence all in its cell, and some beside it. Collected
/// when a leaf is asked for first: few are. Thread-safe.
class LeafTriangles {
 public:
  /// The mesh is referred to and must outlive this.
  explicit LeafTriangles(const TriangleMesh& mesh) : mesh_(mesh) {}

  /// The tree must always be the same.
  const std::vector<BoxedTriangle>& of(const SphereTree& tree, int leaf) const;

 private:
  struct Lazy {
    std::once_flag once;
    std::vector<BoxedTriangle> made;
  };
  const TriangleMesh& mesh_;
  mutable std::once_flag leaves_once_;
  mutable std::unique_ptr<Lazy[]> leaves_;  ///< [nodes]
};

/// Whether two boxed triangles meet, of two leaves whose balls are given; those that the other's ball does not reach
/// are not looked at. FCL's verdict on each pair of triangles. X_AB: b's frame in a's.
bool leaves_meet(const std::vector<BoxedTriangle>& a, const SphereTree::Node& ball_a,
                 const std::vector<BoxedTriangle>& b, const SphereTree::Node& ball_b, const Eigen::Isometry3d& X_AB);

}  // namespace opponens::robot
