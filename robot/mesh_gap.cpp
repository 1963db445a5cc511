// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "robot/bounding_volume_tree.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kExactWithin = 1e-6;   ///< m
constexpr std::size_t kPending = 256;  ///< entries of a descent; wider trees end it with the whole meshes

bool has_triangles(const CollisionShape& shape) {
  return std::holds_alternative<std::shared_ptr<const TriangleMesh>>(shape.shape());
}

/// A mesh's tree of balls with the convex pieces in its leaves.
struct Cover {
  const std::vector<SphereTree::Node>& nodes;
  const std::vector<HullVertices>& hulls;

  explicit Cover(const CollisionShape& mesh) : nodes(mesh.cover().nodes), hulls(mesh.pieces()) {}
  const SphereTree::Node& node(int index) const { return nodes[static_cast<std::size_t>(index)]; }
  /// A leaf that is solid throughout has none.
  bool has_piece(int leaf) const { return hulls[static_cast<std::size_t>(leaf)].all.count > 0; }
  ConvexSolid piece(int leaf) const { return {&hulls[static_cast<std::size_t>(leaf)], node(leaf).center}; }
};

struct LeafPair {
  int a;
  int b;
};

/// What a descent found: the least lower bound, and the pairs of leaves nearer than `enough`.
struct Near {
  double least = kInfinite;
  std::vector<LeafPair>& leaves;
  bool complete = true;
};

void descend(const Cover& a, const Cover& b, const Isometry3d& X_AB, double needed, double enough, Near& near) {
  std::array<LeafPair, kPending> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const LeafPair entry = stack[--size];
    const SphereTree::Node& node_a = a.node(entry.a);
    const SphereTree::Node& node_b = b.node(entry.b);
    const double reach = node_a.radius + node_b.radius + enough;
    if ((node_a.center - X_AB * node_b.center).squaredNorm() > reach * reach) continue;
    const bool divide_a = node_b.children == 0 || (node_a.children > 0 && node_a.radius >= node_b.radius);
    const SphereTree::Node& divided = divide_a ? node_a : node_b;
    if (divided.children == 0) {
      if (!a.has_piece(entry.a) || !b.has_piece(entry.b)) continue;
      Vector3d away = Vector3d::Zero();
      const GapBounds gap = convex_gap(a.piece(entry.a), b.piece(entry.b), X_AB, needed, enough, away);
      if (gap.lower >= enough) continue;
      near.least = std::min(near.least, gap.lower);
      near.leaves.push_back(entry);
      continue;
    }
    if (size + static_cast<std::size_t>(divided.children) > kPending) {
      near.complete = false;
      return;
    }
    for (int child = divided.first_child; child < divided.first_child + divided.children; ++child) {
      stack[size++] = divide_a ? LeafPair{child, entry.b} : LeafPair{entry.a, child};
    }
  }
}

GapBounds two_mesh_gap(const CollisionShape& A, const Isometry3d& X_WA, const CollisionShape& B, const Isometry3d& X_WB,
                       double needed, double enough) {
  thread_local std::vector<LeafPair> leaves;
  leaves.clear();
  Near near{kInfinite, leaves};
  descend(Cover(A), Cover(B), X_WA.inverse(Eigen::Isometry) * X_WB, needed, enough, near);
  if (near.complete && leaves.empty()) return {enough, kInfinite};
  if (near.complete && near.least > needed) return {near.least, kInfinite};
  double distance = enough;
  if (near.complete) {
    for (const LeafPair& pair : leaves) {
      distance = std::min(distance, leaves_distance(A, X_WA, pair.a, B, X_WB, pair.b, distance));
      if (distance < needed) break;
    }
  } else {
    distance = leaves_distance(A, X_WA, 0, B, X_WB, 0, distance);  // the first node's ball holds the whole mesh
  }
  return {std::max(0.0, distance < enough ? distance - kExactWithin : enough), distance < enough ? distance : kInfinite};
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

GapBounds mesh_primitive_gap_bounds(const CollisionShape& mesh, const CollisionShape& primitive, const Isometry3d& X_MP,
                                    double needed, double enough) {
  const Cover cover(mesh);
  const ConvexSolid solid = convex_solid(primitive);
  const Isometry3d X_PM = X_MP.inverse(Eigen::Isometry);
  const OrientedBox box{primitive.center(), Eigen::Matrix3d::Identity(), primitive.half_extents()};
  double least = kInfinite;
  std::array<int, kPending> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0 && least > needed) {
    const int index = stack[--size];
    const SphereTree::Node& node = cover.node(index);
    if (point_box_distance(X_PM * node.center, box) > node.radius + enough) continue;
    if (node.children == 0) {
      if (!cover.has_piece(index)) continue;
      Vector3d away = Vector3d::Zero();
      const GapBounds gap = convex_gap(cover.piece(index), solid, X_MP, needed, enough, away);
      if (gap.lower < enough) least = std::min(least, gap.lower);
      continue;
    }
    if (size + static_cast<std::size_t>(node.children) > kPending) {
      least = 0.0;
      break;
    }
    for (int child = 0; child < node.children; ++child) stack[size++] = node.first_child + child;
  }
  if (least == kInfinite) return {enough, kInfinite};
  if (least > needed) return {least, kInfinite};
  const double distance = triangles_distance(mesh, primitive, X_MP, enough);
  return {distance, distance < enough ? distance + kExactWithin : kInfinite};
}

}  // namespace

GapBounds mesh_gap(const CollisionShape& a, const Isometry3d& X_WA, const CollisionShape& b, const Isometry3d& X_WB,
                   double needed, double enough) {
  if (has_triangles(a) && has_triangles(b)) return two_mesh_gap(a, X_WA, b, X_WB, needed, enough);
  return has_triangles(a)
             ? mesh_primitive_gap_bounds(a, b, X_WA.inverse(Eigen::Isometry) * X_WB, needed, enough)
             : mesh_primitive_gap_bounds(b, a, X_WB.inverse(Eigen::Isometry) * X_WA, needed, enough);
}

}  // namespace opponens::robot
