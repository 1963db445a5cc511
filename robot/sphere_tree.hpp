// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Balls that contain a solid, in its frame, coarse to fine. nodes[0] contains all of it; the part of the solid in a
/// node's ball is contained in the balls of its children together, so that the leaves contain the solid. A child's ball
/// may stick out of its parent's: what is clear of a node's ball is clear of its part of the solid.
struct SphereTree {
  struct Node {
    Eigen::Vector3d center;  ///< m
    double radius;           ///< m
    int first_child;         ///< index of the first of its adjacent children, greater than the node's own
    int children;            ///< 0: a leaf
  };
  std::vector<Node> nodes;
};

struct SphereTreeSettings {
  int leaves = 48;        ///< at most
  double radius = 0.005;  ///< m; smaller balls are not divided
};

/// Covers a shape by construction: the solid is cut by planes into cells; each ball contains all vertices of the
/// surface's triangles clipped to the cell and those of the cell's corners that lie in the solid. These points span the
/// convex hull of the solid inside the cell: an extreme point of it is a corner of the cell when it lies inside the
/// solid, and otherwise a vertex of a clipped triangle. Open components of a mesh are covered as surfaces. A cylinder
/// is cut across its axis only. Cost: O(F log leaves) for F triangles, and up to 20 point queries per node.
SphereTree sphere_tree(const Shape& shape, const SphereTreeSettings& settings = {});

/// Whether a point belongs to a solid whose surface is given; points nearer to the surface than 1e-7 m may count either
/// way. What lies on the surface need not be told.
using Inside = std::function<bool(const Eigen::Vector3d& p)>;

/// The same for any surface. `inside` must be true wherever the solid is, and may be true elsewhere.
SphereTree sphere_tree(const TriangleMesh& surface, const Inside& inside, const SphereTreeSettings& settings);

class SolidRegion;

/// A sphere tree and what it was made of.
struct CellTree {
  SphereTree tree;
  /// [nodes] m; of a leaf the corners of the surface's triangles clipped to its cell, of other nodes none. The convex
  /// hulls of the leaves' points contain the surface together, and those of the leaves below a node its part in the
  /// node's ball.
  std::vector<std::vector<Eigen::Vector3d>> points;
};

/// That of a mesh whose region is known already.
CellTree cell_tree(const TriangleMesh& mesh, const SolidRegion& region, const SphereTreeSettings& settings = {});

}  // namespace opponens::robot
