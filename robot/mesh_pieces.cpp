// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_pieces.hpp"

#include <array>
#include <cmath>

#include "robot/convex_apart.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kMostAsked = 12;       ///< pairs of pieces; more take as long as the whole meshes
constexpr std::size_t kStack = 256;  ///< entries of a descent; wider trees end it with "unknown"

/// Planes keep most pieces apart. Of the triangles in the others the truth is asked.
Solids two_meshes(const CollisionShape& A, const Isometry3d& X_WA, const CollisionShape& B, const Isometry3d& X_WB,
                  double margin) {
  struct Entry {
    int a;
    int b;
  };
  const MeshPieces a(A);
  const MeshPieces b(B);
  const Isometry3d X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  int asked = 0;
  std::array<Entry, kStack> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    const SphereTree::Node& node_a = a.node(entry.a);
    const SphereTree::Node& node_b = b.node(entry.b);
    const double reach = node_a.radius + node_b.radius + margin;
    if ((node_a.center - X_AB * node_b.center).squaredNorm() > reach * reach) continue;
    const bool divide_a = node_b.children == 0 || (node_a.children > 0 && node_a.radius >= node_b.radius);
    const SphereTree::Node& divided = divide_a ? node_a : node_b;
    if (divided.children == 0) {
      if (!a.has_piece(entry.a) || !b.has_piece(entry.b)) continue;
      if (convex_relation(a.piece(entry.a), b.piece(entry.b), X_AB, margin, 0.0) == Convex::apart) continue;
      if (++asked > kMostAsked) return Solids::unknown;
      if (leaves_meet(A, X_WA, entry.a, B, X_WB, entry.b)) return Solids::touching;
      continue;
    }
    if (size + static_cast<std::size_t>(divided.children) > kStack) return Solids::unknown;
    for (int child = divided.first_child; child < divided.first_child + divided.children; ++child) {
      stack[size++] = divide_a ? Entry{child, entry.b} : Entry{entry.a, child};
    }
  }
  return contained(A, X_WA, B, X_WB) ? Solids::touching : Solids::apart;
}

/// Whether a point is inside a primitive by `depth`.
struct DeepInside {
  const Vector3d& p;
  double depth;

  bool operator()(const Box& box) const { return (0.5 * box.size - p.cwiseAbs()).minCoeff() > depth; }
  bool operator()(const Sphere& sphere) const { return p.norm() < sphere.radius - depth; }
  bool operator()(const Cylinder& cylinder) const {
    return p.head<2>().norm() < cylinder.radius - depth && std::abs(p.z()) < 0.5 * cylinder.length - depth;
  }
  bool operator()(const std::shared_ptr<const TriangleMesh>& /*mesh*/) const { return false; }
};

/// Whether a point of the surface in a piece is; known to a rounding that has to be far below that.
bool surface_reaches_into(const HullVertices& piece, const Shape& primitive, const Isometry3d& X_PM, double depth) {
  if (piece.rounding > 0.5 * depth) return false;  // of a mesh that reaches further than some metres
  for (int i = 0; i < piece.all.count; ++i) {
    if (std::visit(DeepInside{X_PM * piece.all.point(i), depth}, primitive)) return true;
  }
  return false;
}

/// Of their surfaces.
Solids mesh_and_primitive(const MeshPieces& mesh, const CollisionShape& primitive, const Isometry3d& X_MP,
                          double margin, double depth) {
  const ConvexSolid solid = convex_solid(primitive);
  const Isometry3d X_PM = X_MP.inverse(Eigen::Isometry);
  const OrientedBox box{primitive.center(), Eigen::Matrix3d::Identity(), primitive.half_extents()};
  Solids found = Solids::apart;
  std::array<int, kStack> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const int index = stack[--size];
    const SphereTree::Node& node = mesh.node(index);
    if (point_box_distance(X_PM * node.center, box) > node.radius + margin) continue;
    if (node.children == 0) {
      if (!mesh.has_piece(index)) continue;
      if (convex_relation(mesh.piece(index), solid, X_MP, margin, 0.0) == Convex::apart) continue;
      found = Solids::unknown;
      const HullVertices& piece = mesh.hulls[static_cast<std::size_t>(index)];
      if (surface_reaches_into(piece, primitive.shape(), X_PM, depth)) return Solids::touching;
      continue;
    }
    if (size + static_cast<std::size_t>(node.children) > kStack) return Solids::unknown;
    for (int child = 0; child < node.children; ++child) stack[size++] = node.first_child + child;
  }
  return found;
}

}  // namespace

Solids pieces_relation(const CollisionShape& a, const Isometry3d& X_WA, const CollisionShape& b, const Isometry3d& X_WB,
                       double margin, double depth) {
  if (is_mesh(a) && is_mesh(b)) return two_meshes(a, X_WA, b, X_WB, margin);
  const Solids surfaces =
      is_mesh(a) ? mesh_and_primitive(MeshPieces(a), b, X_WA.inverse(Eigen::Isometry) * X_WB, margin, depth)
                 : mesh_and_primitive(MeshPieces(b), a, X_WB.inverse(Eigen::Isometry) * X_WA, margin, depth);
  return surfaces == Solids::apart && contained(a, X_WA, b, X_WB) ? Solids::touching : surfaces;
}

}  // namespace opponens::robot
