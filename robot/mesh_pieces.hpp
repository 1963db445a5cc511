// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: what the convex pieces of meshes tell of two solids.
#pragma once

#include <Eigen/Geometry>

#include "robot/narrow_phase.hpp"

namespace opponens::robot {

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
