// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_hull.hpp"

#include <limits>

#include "robot/quickhull.hpp"

namespace opponens::robot {

namespace {

constexpr int kPadding = 8;

/// Vertices that triangles have, ascending: another is no point of the solid.
std::vector<Eigen::Index> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> is_used(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) is_used[static_cast<std::size_t>(mesh.triangles(k, f))] = true;
  }
  std::vector<Eigen::Index> used;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    if (is_used[static_cast<std::size_t>(i)]) used.push_back(i);
  }
  return used;
}

}  // namespace

HullVertices hull_vertices(const TriangleMesh& mesh) {
  const std::vector<Eigen::Index> used = used_vertices(mesh);
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(used.size()));
  for (std::size_t i = 0; i < used.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = mesh.vertices.col(used[i]);
  std::vector<Eigen::Index> indices;
  if (const auto hull = Quickhull::build(points, "Qt")) {
    for (const Eigen::Index i : hull->vertices()) indices.push_back(used[static_cast<std::size_t>(i)]);
  } else {
    indices = used;
  }
  HullVertices hull;
  hull.count = (static_cast<int>(indices.size()) + kPadding - 1) / kPadding * kPadding;
  const auto count = static_cast<std::size_t>(hull.count);
  hull.xyz.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Index source = indices[i < indices.size() ? i : 0];
    for (std::size_t k = 0; k < 3; ++k) {
      hull.xyz[k * count + i] = static_cast<float>(mesh.vertices(static_cast<Eigen::Index>(k), source));
    }
  }
  // Of storing, of qhull's merged facets, and of the farthest vertex found in single precision.
  hull.rounding = 16.0 * std::numeric_limits<float>::epsilon() * mesh.vertices.cwiseAbs().maxCoeff();
  return hull;
}

}  // namespace opponens::robot
