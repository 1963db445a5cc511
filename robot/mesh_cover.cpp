// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_cover.hpp"

#include <utility>

#include "robot/solid_region.hpp"

namespace opponens::robot {

namespace {

/// Of a leaf's points; none where a cell is solid throughout.
HullVertices piece(const std::vector<Eigen::Vector3d>& own) {
  if (own.empty()) return {};
  const Eigen::Map<const Eigen::Matrix3Xd> points(own.data()->data(), 3, static_cast<Eigen::Index>(own.size()));
  return hull_vertices(points(Eigen::all, hull_indices(points)));
}

}  // namespace

MeshCover mesh_cover(const TriangleMesh& mesh, const SolidRegion& region) {
  CellTree made = cell_tree(mesh, region);
  MeshCover cover{std::move(made.tree), {}, hull_vertices(mesh)};
  for (const auto& points : made.points) cover.pieces.push_back(piece(points));
  return cover;
}

MeshCover mesh_cover(const TriangleMesh& mesh) { return mesh_cover(mesh, SolidRegion(mesh)); }

}  // namespace opponens::robot
