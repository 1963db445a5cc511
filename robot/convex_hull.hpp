// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Vertices of a mesh's convex hull as three rows of single-precision coordinates, padded with copies of the first to a
/// multiple of eight, so that the farthest in a direction is found eight at a time.
struct HullVertices {
  int count = 0;           ///< padded
  std::vector<float> xyz;  ///< [3 x count] m, one coordinate after the other
  double rounding = 0.0;   ///< m; the true hull lies within this of the stored points' hull
  Eigen::Vector3d vertex(int index) const {
    const auto i = static_cast<std::size_t>(index);
    const auto n = static_cast<std::size_t>(count);
    return {xyz[i], xyz[n + i], xyz[2 * n + i]};
  }
};

/// By qhull (exact but for its own rounding); all vertices (that triangles have) of a mesh that spans no volume.
HullVertices hull_vertices(const TriangleMesh& mesh);

}  // namespace opponens::robot
