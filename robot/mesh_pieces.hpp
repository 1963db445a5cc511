// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: what the convex pieces of meshes tell of two solids.
#pragma once

#include <cstddef>
#include <memory>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "robot/convex_apart.hpp"
#include "robot/narrow_phase.hpp"

namespace opponens::robot {

inline bool is_mesh(const CollisionShape& shape) {
  return std::holds_alternative<std::shared_ptr<const TriangleMesh>>(shape.shape());
}

/// A mesh's tree of balls with the convex pieces in its leaves; refers to the mesh.
struct MeshPieces {
  const std::vector<SphereTree::Node>& nodes;
  const std::vector<HullVertices>& hulls;

  explicit MeshPieces(const CollisionShape& mesh) : nodes(mesh.cover().nodes), hulls(mesh.pieces()) {}
  const SphereTree::Node& node(int index) const { return nodes[static_cast<std::size_t>(index)]; }
  /// A leaf that is solid throughout has none.
  bool has_piece(int leaf) const { return hulls[static_cast<std::size_t>(leaf)].all.count > 0; }
  ConvexSolid piece(int leaf) const { return {&hulls[static_cast<std::size_t>(leaf)], node(leaf).center}; }
};

enum class Solids { apart, touching, unknown };

/// What is certain of two shapes, at least one of them a mesh, by a descent in their trees to the convex pieces that
/// contain their surfaces (MeshCover). Those of a mesh and a primitive are
/// - apart when planes keep all pieces whose balls meet more than `margin` (m) apart;
/// - touching when a point of the mesh was found inside the primitive, deeper than `depth` (m).
/// Of two meshes the truth is asked about the triangles in pieces that no plane keeps apart: its verdict is that on the
/// whole meshes, as all other triangles are further apart than its tolerance. Where surfaces are apart, the truth is
/// asked whether one solid contains the other.
Solids pieces_relation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, double margin, double depth);

}  // namespace opponens::robot
