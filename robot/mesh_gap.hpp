// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: how far the surfaces of two shapes are apart, at least one of them a mesh.
#pragma once

#include <Eigen/Geometry>

#include "robot/convex_apart.hpp"
#include "robot/narrow_phase.hpp"

namespace opponens::robot {

/// Bounds of the distance of two surfaces, m, as far as it takes to tell that it is at least `enough` (upper is then
/// infinite) or below `needed` (needed <= enough): by the convex pieces that contain the meshes' surfaces (MeshCover),
/// and where some of these come nearer than `needed` by the triangles, which gives the distance within 1e-6 m. Where
/// the pieces say something in between, they say it. One solid inside the other is not looked for.
GapBounds mesh_gap(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                   const Eigen::Isometry3d& X_WB, double needed, double enough);

}  // namespace opponens::robot
