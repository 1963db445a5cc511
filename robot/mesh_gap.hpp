// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: how far the surfaces of two shapes are apart, at least one of them a mesh.
#pragma once

#include <Eigen/Geometry>

#include "robot/convex_apart.hpp"
#include "robot/narrow_phase.hpp"

namespace opponens::robot {

/// X_AB of poses in a common frame, rotations taken to be exact.
inline Eigen::Isometry3d relative_pose(const Eigen::Isometry3d& X_WA, const Eigen::Isometry3d& X_WB) {
  Eigen::Isometry3d X_AB = Eigen::Isometry3d::Identity();
  X_AB.linear() = X_WA.linear().transpose() * X_WB.linear();
  X_AB.translation() = X_WA.linear().transpose() * (X_WB.translation() - X_WA.translation());
  return X_AB;
}

/// Leaves of two covers; -1: none. Of a primitive 0.
struct LeafPair {
  int a = -1;
  int b = -1;
};

/// Whether the surfaces are at least `enough` apart (m), by the convex pieces that contain them (MeshCover). One solid
/// inside the other is not looked for. last: a pair of pieces to try first; set to one that is nearer.
bool pieces_keep(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                 const Eigen::Isometry3d& X_WB, double enough, LeafPair& last);

/// The distance of the surfaces, m, or `enough` when that is less: of the triangles in pieces nearer than that. Within
/// 1e-6 m below it. Not looked for further where it is below `needed`.
double mesh_distance(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                     const Eigen::Isometry3d& X_WB, double needed, double enough);

}  // namespace opponens::robot
