// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: what the convex pieces of meshes tell of two solids.
#pragma once

#include <Eigen/Geometry>

#include "robot/narrow_phase.hpp"

namespace opponens::robot {

enum class Solids { apart, touching, unknown };

/// What is certain of two shapes, at least one of them a mesh, by a descent in their trees to the convex pieces that
/// contain them (MeshCover):
/// - apart: planes were found that keep all pieces whose balls meet more than `margin` (m) apart;
/// - touching: a point of a mesh's surface was found inside a primitive, deeper than `depth` (m).
/// Allocates nothing.
Solids pieces_relation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, double margin, double depth);

}  // namespace opponens::robot
