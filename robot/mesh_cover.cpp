// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_cover.hpp"

#include <algorithm>
#include <utility>

#include "robot/solid_region.hpp"

namespace opponens::robot {

namespace {

HullVertices piece(const CellTree::Cell& cell) {
  const Eigen::Map<const Eigen::Matrix3Xd> points(cell.points.data()->data(), 3,
                                                  static_cast<Eigen::Index>(cell.points.size()));
  const std::vector<Eigen::Index> extreme = hull_indices(points);
  const auto filled = std::lower_bound(extreme.begin(), extreme.end(), cell.on_surface);
  return hull_vertices(points(Eigen::all, extreme), static_cast<int>(filled - extreme.begin()));
}

}  // namespace

MeshCover mesh_cover(const TriangleMesh& mesh, const SolidRegion& region) {
  CellTree made = cell_tree(mesh, region);
  MeshCover cover{std::move(made.tree), {}, hull_vertices(mesh)};
  for (const CellTree::Cell& cell : made.cells) {
    cover.pieces.push_back(cell.points.empty() ? HullVertices{} : piece(cell));
  }
  return cover;
}

MeshCover mesh_cover(const TriangleMesh& mesh) { return mesh_cover(mesh, SolidRegion(mesh)); }

}  // namespace opponens::robot
