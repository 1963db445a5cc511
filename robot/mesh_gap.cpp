// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <variant>

#include "robot/bounding_volume_tree.hpp"
#include "robot/mesh_pieces.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kExactWithin = 1e-6;  ///< m
constexpr std::size_t kPending = 256;  ///< entries of a descent; wider trees end it with the whole meshes

Vector3d moved_point(const Isometry3d& X, const Vector3d& p) { return X.linear() * p + X.translation(); }

/// Calls open(leaf_a, leaf_b) for all leaves whose balls (of a primitive: box) come nearer than `enough`, until it
/// returns true; whether it did. Also true where a tree is too wide.
template <typename Open>
bool any_near(const MeshPieces& a, const MeshPieces& b, const Isometry3d& X_AB, double enough, const Open& open) {
  std::array<LeafPair, kPending> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const LeafPair entry = stack[--size];
    const SphereTree::Node& node_a = a.node(entry.a);
    const SphereTree::Node& node_b = b.node(entry.b);
    const double reach = node_a.radius + node_b.radius + enough;
    if ((node_a.center - moved_point(X_AB, node_b.center)).squaredNorm() > reach * reach) continue;
    const bool divide_a = node_b.children == 0 || (node_a.children > 0 && node_a.radius >= node_b.radius);
    const SphereTree::Node& divided = divide_a ? node_a : node_b;
    if (divided.children == 0) {
      if (a.has_piece(entry.a) && b.has_piece(entry.b) && open(entry)) return true;
      continue;
    }
    if (size + static_cast<std::size_t>(divided.children) > kPending) return true;
    for (int child = divided.first_child; child < divided.first_child + divided.children; ++child) {
      stack[size++] = divide_a ? LeafPair{child, entry.b} : LeafPair{entry.a, child};
    }
  }
  return false;
}

template <typename Open>
bool any_near(const MeshPieces& mesh, const CollisionShape& primitive, const Isometry3d& X_MP, double enough,
              const Open& open) {
  const OrientedBox box{moved_point(X_MP, primitive.center()), X_MP.linear(), primitive.half_extents()};
  std::array<int, kPending> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const int index = stack[--size];
    const SphereTree::Node& node = mesh.node(index);
    if (point_box_distance(node.center, box) > node.radius + enough) continue;
    if (node.children == 0) {
      if (mesh.has_piece(index) && open(LeafPair{index, 0})) return true;
      continue;
    }
    if (size + static_cast<std::size_t>(node.children) > kPending) return true;
    for (int child = 0; child < node.children; ++child) stack[size++] = node.first_child + child;
  }
  return false;
}

bool solids_keep(const ConvexSolid& a, const ConvexSolid& b, const Isometry3d& X_AB, double enough) {
  Vector3d away = Vector3d::Zero();
  return convex_gap(a, b, X_AB, enough, enough, away).lower >= enough;
}

/// keep(leaves): whether two pieces do.
template <typename AnyNear, typename Keep>
bool all_keep(const AnyNear& any, const Keep& keep, LeafPair& last) {
  if (last.a >= 0 && !keep(last)) return false;
  return !any([&](const LeafPair& leaves) {
    if (keep(leaves)) return false;
    last = leaves;
    return true;
  });
}

bool mesh_primitive_keep(const CollisionShape& mesh, const CollisionShape& primitive, const Isometry3d& X_MP,
                         double enough, LeafPair& last) {
  const MeshPieces cover(mesh);
  const ConvexSolid solid = convex_solid(primitive);
  return all_keep([&](const auto& open) { return any_near(cover, primitive, X_MP, enough, open); },
                  [&](const LeafPair& leaves) { return solids_keep(cover.piece(leaves.a), solid, X_MP, enough); },
                  last);
}

bool two_meshes_keep(const CollisionShape& A, const CollisionShape& B, const Isometry3d& X_AB, double enough,
                     LeafPair& last) {
  const MeshPieces a(A);
  const MeshPieces b(B);
  return all_keep(
      [&](const auto& open) { return any_near(a, b, X_AB, enough, open); },
      [&](const LeafPair& leaves) { return solids_keep(a.piece(leaves.a), b.piece(leaves.b), X_AB, enough); }, last);
}

double two_meshes_distance(const CollisionShape& A, const Isometry3d& X_WA, const CollisionShape& B,
                           const Isometry3d& X_WB, double needed, double enough) {
  const MeshPieces a(A);
  const MeshPieces b(B);
  const Isometry3d X_AB = relative_pose(X_WA, X_WB);
  double distance = enough;
  const bool ended = any_near(a, b, X_AB, enough, [&](const LeafPair& leaves) {
    if (!solids_keep(a.piece(leaves.a), b.piece(leaves.b), X_AB, distance)) {
      distance = leaves_distance(A, X_WA, leaves.a, B, X_WB, leaves.b, distance);
    }
    return distance < needed;
  });
  // A tree too wide for the descent: its first node's ball holds the whole mesh.
  if (ended && distance >= needed) distance = leaves_distance(A, X_WA, 0, B, X_WB, 0, distance);
  return distance < enough ? std::max(0.0, distance - kExactWithin) : enough;
}

/// Distance between the triangles of a mesh and a primitive, or `limit` when that is less; within 1e-6 m below it.
double triangles_distance(const CollisionShape& mesh, const CollisionShape& primitive, const Isometry3d& X_MP,
                          double limit) {
  const BoundingVolumeTree& triangles = mesh.triangles();
  if (const auto* sphere = std::get_if<Sphere>(&primitive.shape())) {
    return std::clamp(std::sqrt(triangles.nearest(X_MP.translation()).squared_distance) - sphere->radius, 0.0, limit);
  }
  const OrientedBox around{X_MP * primitive.center(), X_MP.linear(), primitive.half_extents()};
  const ConvexSolid solid = convex_solid(primitive);
  double best = limit;
  return triangles.least(
      [&](const Vector3d& center, const Vector3d& half_extents) {
        return box_gap({center, Eigen::Matrix3d::Identity(), half_extents}, around);
      },
      [&](const Vector3d& a, const Vector3d& ab, const Vector3d& ac) {
        Vector3d away = Vector3d::Zero();
        const ConvexSolid facet{Facet{a, a + ab, a + ac}, a + (ab + ac) / 3.0};
        best = std::min(best, convex_gap(facet, solid, X_MP, 0.0, best, away).lower);
        return best;
      },
      limit);
}

}  // namespace

bool pieces_keep(const CollisionShape& a, const Isometry3d& X_WA, const CollisionShape& b, const Isometry3d& X_WB,
                 double enough, LeafPair& last) {
  if (!is_mesh(b)) return mesh_primitive_keep(a, b, relative_pose(X_WA, X_WB), enough, last);
  if (!is_mesh(a)) return mesh_primitive_keep(b, a, relative_pose(X_WB, X_WA), enough, last);
  return two_meshes_keep(a, b, relative_pose(X_WA, X_WB), enough, last);
}

double mesh_distance(const CollisionShape& a, const Isometry3d& X_WA, const CollisionShape& b, const Isometry3d& X_WB,
                     double needed, double enough) {
  if (!is_mesh(b)) return triangles_distance(a, b, relative_pose(X_WA, X_WB), enough);
  if (!is_mesh(a)) return triangles_distance(b, a, relative_pose(X_WB, X_WA), enough);
  return two_meshes_distance(a, X_WA, b, X_WB, needed, enough);
}

}  // namespace opponens::robot
