// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_apart.hpp"

#include <array>
#include <cmath>

#include "robot/bounding_volume_tree.hpp"
#include "robot/convex_hull.hpp"
#include "robot/grown_polytope.hpp"
#include "robot/wide_world.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr int kSteps = 20;

/// The point of a shape that is farthest along n, in the shape's frame.
struct Support {
  const CollisionShape& owner;
  const Vector3d& n;

  Vector3d operator()(const Box& box) const {
    return 0.5 * Vector3d(std::copysign(box.size.x(), n.x()), std::copysign(box.size.y(), n.y()),
                          std::copysign(box.size.z(), n.z()));
  }
  Vector3d operator()(const Sphere& sphere) const { return n * (sphere.radius / n.norm()); }
  Vector3d operator()(const Cylinder& c) const {
    const double across = n.head<2>().norm();
    Vector3d p(0.0, 0.0, std::copysign(0.5 * c.length, n.z()));
    if (across > 0.0) p.head<2>() = n.head<2>() * (c.radius / across);
    return p;
  }
  Vector3d operator()(const std::shared_ptr<const TriangleMesh>&) const {
    const HullVertices& hull = owner.hull();
    return hull.vertex(wide::farthest(hull.xyz.data(), hull.count, n.cast<float>().eval().data()));
  }
};

/// Corners of a simplex that holds the point of the difference found nearest to the origin so far.
struct Simplex {
  std::array<Vector3d, 4> corner;
  int size = 0;
};

/// Nearest point of a triangle to the origin; the simplex keeps the corners of the feature that holds it.
Vector3d nearest_of_triangle(Simplex& simplex) {
  const std::array<Vector3d, 3> c{simplex.corner[0], simplex.corner[1], simplex.corner[2]};
  const TrianglePoint on = nearest_on_triangle(c[0], c[1] - c[0], c[2] - c[0], Vector3d::Zero());
  const int feature = static_cast<int>(on.feature);
  if (feature < 3) {
    simplex.corner[0] = c[static_cast<std::size_t>(feature)];
    simplex.size = 1;
  } else if (feature < 6) {
    simplex.corner[0] = c[static_cast<std::size_t>(feature - 3)];
    simplex.corner[1] = c[static_cast<std::size_t>((feature - 2) % 3)];
    simplex.size = 2;
  }
  return on.point;
}

Vector3d nearest_of_segment(Simplex& simplex) {
  const Vector3d a = simplex.corner[0];
  const Vector3d ab = simplex.corner[1] - a;
  const double t = -a.dot(ab) / ab.squaredNorm();
  if (t > 0.0 && t < 1.0) return a + t * ab;
  if (t >= 1.0) simplex.corner[0] = simplex.corner[1];
  simplex.size = 1;
  return simplex.corner[0];
}

/// Nearest of the faces that the origin is outside of; the origin itself when it is inside.
Vector3d nearest_of_tetrahedron(Simplex& simplex) {
  static constexpr std::array<std::array<std::size_t, 4>, 4> kFaces{
      {{{0, 1, 2, 3}}, {{0, 2, 3, 1}}, {{0, 3, 1, 2}}, {{1, 3, 2, 0}}}};  // three corners and the one across
  const Simplex whole = simplex;
  Vector3d best = Vector3d::Zero();
  double least = -1.0;
  for (const auto& face : kFaces) {
    const Vector3d& a = whole.corner[face[0]];
    const Vector3d n = (whole.corner[face[1]] - a).cross(whole.corner[face[2]] - a);
    if (n.dot(a) * n.dot(a - whole.corner[face[3]]) > 0.0) continue;  // the origin is on the inner side
    Simplex part{{a, whole.corner[face[1]], whole.corner[face[2]], a}, 3};
    const Vector3d point = nearest_of_triangle(part);
    if (least >= 0.0 && point.squaredNorm() >= least) continue;
    least = point.squaredNorm();
    best = point;
    simplex = part;
  }
  return best;
}

Vector3d nearest(Simplex& simplex) {
  if (simplex.size == 1) return simplex.corner[0];
  if (simplex.size == 2) return nearest_of_segment(simplex);
  return simplex.size == 3 ? nearest_of_triangle(simplex) : nearest_of_tetrahedron(simplex);
}

}  // namespace

bool convex_apart(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB, double margin) {
  return convex_relation(a, X_WA, b, X_WB, margin, 0.0) == Convex::apart;
}

Convex convex_relation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, double margin, double depth) {
  const Eigen::Isometry3d X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  const double rounding = a.hull_rounding() + b.hull_rounding();
  margin += rounding;
  const auto support = [&](const Vector3d& n) -> Vector3d {  // of the difference A - B
    const Vector3d turned = -(X_AB.linear().transpose() * n);
    return std::visit(Support{a, n}, a.shape()) - X_AB * std::visit(Support{b, turned}, b.shape());
  };
  Vector3d v = a.center() - X_AB * b.center();
  Simplex simplex;
  for (int step = 0; step < kSteps; ++step) {
    const double length = v.norm();
    if (!(length > margin)) {
      const bool inside = simplex.size == 4 && depth > 0.0;
      return inside && comes_to_hold_ball(simplex.corner, depth + rounding, support) ? Convex::overlapping
                                                                                     : Convex::unknown;
    }
    const Vector3d w = support(-v);
    const double ahead = v.dot(w);
    if (ahead > margin * length) return Convex::apart;
    // No support point is nearer than those known: v is the nearest point itself, less than margin away.
    if (step > 0 && length * length - ahead <= 1e-9 * length * length) return Convex::unknown;
    simplex.corner[static_cast<std::size_t>(simplex.size++)] = w;
    v = nearest(simplex);
  }
  return Convex::unknown;
}

}  // namespace opponens::robot
