// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/leaf_triangles.hpp"

#include <cstddef>

#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

namespace opponens::robot {

namespace {

constexpr double kSlack = 1e-9;      ///< m, far above the rounding of a distance between bodies
constexpr double kBallSlack = 1e-6;  ///< of a ball's radius, likewise

bool reaches(const BoxedTriangle& triangle, const Eigen::Vector3d& center, double radius) {
  return !(triangle.box.squaredExteriorDistance(center) > radius * radius);
}

BoxedTriangle boxed(const Eigen::Matrix3d& corners) {
  return {corners, Eigen::AlignedBox3d(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff())};
}

/// Enlarged: the boxes of the others need no slack then.
BoxedTriangle moved(const BoxedTriangle& triangle, const Eigen::Isometry3d& X) {
  BoxedTriangle there = boxed((X.linear() * triangle.corners).colwise() + X.translation());
  there.box.min().array() -= kSlack;
  there.box.max().array() += kSlack;
  return there;
}

bool meet(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return fcl::detail::Intersect<double>::intersect_Triangle(a.col(0), a.col(1), a.col(2), b.col(0), b.col(1), b.col(2));
}

BoxedTriangle triangle_of(const TriangleMesh& mesh, Eigen::Index index) {
  Eigen::Matrix3d corners;
  for (int k = 0; k < 3; ++k) corners.col(k) = mesh.vertices.col(mesh.triangles(k, index));
  return boxed(corners);
}

}  // namespace

std::vector<Eigen::Index> triangles_near(const TriangleMesh& mesh, const SphereTree::Node& ball) {
  std::vector<Eigen::Index> near;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    if (reaches(triangle_of(mesh, f), ball.center, ball.radius * (1.0 + kBallSlack) + kSlack)) near.push_back(f);
  }
  return near;
}

const std::vector<BoxedTriangle>& LeafTriangles::of(const SphereTree& tree, int leaf) const {
  std::call_once(leaves_once_, [&] { leaves_ = std::make_unique<Lazy[]>(tree.nodes.size()); });
  Lazy& own = leaves_[static_cast<std::size_t>(leaf)];
  std::call_once(own.once, [&] {
    for (const Eigen::Index f : triangles_near(mesh_, tree.nodes[static_cast<std::size_t>(leaf)])) {
      own.made.push_back(triangle_of(mesh_, f));
    }
  });
  return own.made;
}

bool leaves_meet(const std::vector<BoxedTriangle>& a, const SphereTree::Node& ball_a,
                 const std::vector<BoxedTriangle>& b, const SphereTree::Node& ball_b, const Eigen::Isometry3d& X_AB) {
  const Eigen::Vector3d center_of_b = X_AB * ball_b.center;
  const Eigen::Vector3d center_of_a = X_AB.inverse(Eigen::Isometry) * ball_a.center;
  thread_local std::vector<BoxedTriangle> near;  // of b, in a's frame
  near.clear();
  Eigen::AlignedBox3d all;
  for (const BoxedTriangle& triangle : b) {
    if (!reaches(triangle, center_of_a, ball_a.radius + kSlack)) continue;
    near.push_back(moved(triangle, X_AB));
    all.extend(near.back().box);
  }
  for (const BoxedTriangle& triangle : a) {
    if (!triangle.box.intersects(all) || !reaches(triangle, center_of_b, ball_b.radius + kSlack)) continue;
    for (const BoxedTriangle& other : near) {
      if (triangle.box.intersects(other.box) && meet(triangle.corners, other.corners)) return true;
    }
  }
  return false;
}

}  // namespace opponens::robot
