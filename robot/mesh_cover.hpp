// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "robot/convex_hull.hpp"
#include "robot/geometry.hpp"
#include "robot/sphere_tree.hpp"

namespace opponens::robot {

/// What the collision checker makes of a mesh before its first question.
struct MeshCover {
  SphereTree tree;
  /// [nodes] of a leaf the convex hull of a part of the surface, of other nodes nothing. The hulls of the leaves
  /// contain the surface together, and those of the leaves below a node its part in the node's ball.
  std::vector<HullVertices> pieces;
  HullVertices hull;  ///< of the whole mesh
};

/// Of vertices and triangles alone. About 2 s per million triangles.
MeshCover mesh_cover(const TriangleMesh& mesh);

/// The same of a mesh whose region is known already.
MeshCover mesh_cover(const TriangleMesh& mesh, const SolidRegion& region);

}  // namespace opponens::robot
