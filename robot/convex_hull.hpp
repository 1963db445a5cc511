// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Points as three rows of single-precision coordinates, padded with copies of the first to a multiple of eight, so
/// that the farthest in a direction is found eight at a time.
struct PaddedPoints {
  int count = 0;           ///< padded
  std::vector<float> xyz;  ///< [3 x count] m, one coordinate after the other
  Eigen::Vector3d point(int index) const {
    const auto i = static_cast<std::size_t>(index);
    const auto n = static_cast<std::size_t>(count);
    return {xyz[i], xyz[n + i], xyz[2 * n + i]};
  }
};

/// Vertices of a convex hull.
struct HullVertices {
  PaddedPoints all;
  PaddedPoints few;       ///< of many, those farthest in some directions, to search among first; of few none
  double rounding = 0.0;  ///< m; the true hull lies within this of the stored points' hull
};

/// Which of some points, [3 x n] m, are vertices of their convex hull, by qhull (exact but for its own rounding),
/// ascending; all of them when they lie on a line. Of points in a plane also a few others may be named.
std::vector<Eigen::Index> hull_indices(const Eigen::Matrix3Xd& points);

/// Of points that are vertices of a hull, [3 x n] m, n >= 1.
HullVertices hull_vertices(const Eigen::Matrix3Xd& points);

/// Of a mesh's vertices that triangles have: another is no point of the solid.
HullVertices hull_vertices(const TriangleMesh& mesh);

}  // namespace opponens::robot
