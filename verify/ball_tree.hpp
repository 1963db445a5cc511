// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::verify {

/// Distance from p to the triangle (a, b, c), m; a triangle without area is its edges.
double triangle_distance(const Eigen::Matrix3d& corners, const Eigen::Vector3d& p);

/// Balls around the triangles of a mesh, halved at the median of their middles along the longest side, at most 4
/// triangles in a leaf; verify's own, so that it shares no tree with robot/. Refers to the mesh. Build O(F log F).
class BallTree {
 public:
  struct Ball {
    Eigen::Vector3d center;  ///< m
    double radius;           ///< m, around all its triangles
    int begin, end;          ///< into order()
    int next;                ///< the first ball that is not inside this one; children follow their parent
    bool leaf;
  };

  explicit BallTree(const robot::TriangleMesh& mesh);

  /// Depth first.
  const std::vector<Ball>& balls() const { return balls_; }
  /// Triangle indices; a ball holds a range of them.
  const std::vector<int>& order() const { return order_; }
  /// [3 x 3] m, columns.
  Eigen::Matrix3d corners(int triangle) const;

  /// m, to the surface; `bound` is returned when nothing is nearer.
  double distance(const Eigen::Vector3d& p, double bound) const;

 private:
  void enclose(const Eigen::Matrix3Xd& middles, int begin, int end);

  const robot::TriangleMesh* mesh_;
  std::vector<Ball> balls_;
  std::vector<int> order_;
};

}  // namespace opponens::verify
