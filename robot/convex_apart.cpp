// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_apart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "robot/bounding_volume_tree.hpp"
#include "robot/convex_hull.hpp"
#include "robot/grown_polytope.hpp"
#include "robot/wide_world.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr int kSteps = 20;
constexpr int kGapSteps = 60;
constexpr double kGapTolerance = 1e-6;  ///< m
constexpr double kCoincident = 1e-12;   ///< m

/// The point of a solid that is farthest along n, in the solid's frame.
struct Support {
  const Vector3d& n;
  bool thorough;  ///< otherwise among few of a hull's vertices

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
  Vector3d operator()(const Facet& facet) const {
    const double a = n.dot(facet.a);
    const double b = n.dot(facet.b);
    const double c = n.dot(facet.c);
    if (a >= b) return a >= c ? facet.a : facet.c;
    return b >= c ? facet.b : facet.c;
  }
  Vector3d operator()(const HullVertices* hull) const {
    const PaddedPoints& points = thorough || hull->few.count == 0 ? hull->all : hull->few;
    return points.point(wide::farthest(points.xyz.data(), points.count, n.cast<float>().eval().data()));
  }
};

/// m; a solid lies within this of what its support points tell.
double rounding_of(const ConvexSolid& solid) {
  const auto* hull = std::get_if<const HullVertices*>(&solid.form);
  return hull == nullptr ? 0.0 : (*hull)->rounding;
}

struct FormOf {
  const CollisionShape& owner;

  ConvexForm operator()(const std::shared_ptr<const TriangleMesh>&) const { return &owner.hull(); }
  ConvexForm operator()(const auto& primitive) const { return primitive; }
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

ConvexSolid convex_solid(const CollisionShape& shape) {
  return {std::visit(FormOf{shape}, shape.shape()), shape.center()};
}

bool convex_apart(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB, double margin) {
  return convex_relation(a, X_WA, b, X_WB, margin, 0.0) == Convex::apart;
}

Convex convex_relation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, double margin, double depth) {
  return convex_relation(convex_solid(a), convex_solid(b), X_WA.inverse(Eigen::Isometry) * X_WB, margin, depth);
}

Convex convex_relation(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB, double margin,
                       double depth) {
  const double rounding = rounding_of(a) + rounding_of(b);
  margin += rounding;
  const auto support = [&](const Vector3d& n, bool thorough) -> Vector3d {
    const Vector3d turned = -(X_AB.linear().transpose() * n);
    return std::visit(Support{n, thorough}, a.form) - X_AB * std::visit(Support{turned, thorough}, b.form);
  };
  Vector3d v = a.center - X_AB * b.center;  // of the difference A - B
  Simplex simplex;
  for (int step = 0; step < kSteps; ++step) {
    const double length = v.norm();
    if (!(length > margin)) {
      const bool inside = simplex.size == 4 && depth > 0.0;
      const auto farthest = [&](const Vector3d& n) { return support(n, true); };
      return inside && comes_to_hold_ball(simplex.corner, depth + rounding, farthest) ? Convex::overlapping
                                                                                      : Convex::unknown;
    }
    // No support point is nearer than those known: v is the nearest point itself, less than margin away.
    const auto settled = [&](double ahead) { return step > 0 && length * length - ahead <= 1e-9 * length * length; };
    Vector3d w = support(-v, false);
    if (v.dot(w) > margin * length || settled(v.dot(w))) {  // among few points: what does each of them say?
      w = support(-v, true);
      if (v.dot(w) > margin * length) return Convex::apart;
      if (settled(v.dot(w))) return Convex::unknown;
    }
    simplex.corner[static_cast<std::size_t>(simplex.size++)] = w;
    v = nearest(simplex);
  }
  return Convex::unknown;
}

namespace {

/// A sphere is its center and a radius: steps on the round surface would only come near to it.
double take_radius(ConvexSolid& solid) {
  auto* sphere = std::get_if<Sphere>(&solid.form);
  return sphere == nullptr ? 0.0 : std::exchange(sphere->radius, 0.0);
}

/// convex_gap of what is not a sphere.
GapBounds gap_by_steps(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB, double needed,
                       double enough, Vector3d& away) {
  const double rounding = rounding_of(a) + rounding_of(b);
  const auto support = [&](const Vector3d& n, bool thorough) -> Vector3d {
    const Vector3d turned = -(X_AB.linear().transpose() * n);
    return std::visit(Support{n, thorough}, a.form) - X_AB.linear() * std::visit(Support{turned, thorough}, b.form) -
           X_AB.translation();
  };
  Vector3d v = away.isZero(kCoincident) ? Vector3d(a.center - X_AB * b.center) : away;
  if (v.isZero(kCoincident)) v = Vector3d::UnitX();
  Simplex simplex;
  GapBounds gap{0.0, std::numeric_limits<double>::infinity()};
  for (int step = 0; step < kGapSteps; ++step) {
    const double length = v.norm();
    if (step > 0) {
      // Below what a plane has proven: a simplex without volume was taken for one around the origin.
      if (length + kGapTolerance < gap.lower) return gap;
      gap.upper = std::min(gap.upper, length + rounding);
      if (gap.upper < needed || length <= kCoincident) return gap;
    }
    away = v;
    Vector3d w = support(-v, false);
    double ahead = v.dot(w) / length;
    if (ahead >= enough + rounding || (step > 0 && length - ahead <= kGapTolerance)) {
      w = support(-v, true);
      ahead = v.dot(w) / length;
      gap.lower = std::max(gap.lower, ahead - rounding);
      if (gap.lower >= enough || (step > 0 && length - ahead <= kGapTolerance)) return gap;
    }
    simplex.corner[static_cast<std::size_t>(simplex.size++)] = w;
    v = nearest(simplex);
  }
  return gap;
}

}  // namespace

GapBounds convex_gap(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB, double needed,
                     double enough, Eigen::Vector3d& away) {
  ConvexSolid core_a = a;
  ConvexSolid core_b = b;
  const double radii = take_radius(core_a) + take_radius(core_b);
  const GapBounds cores = gap_by_steps(core_a, core_b, X_AB, needed + radii, enough + radii, away);
  return {std::max(0.0, cores.lower - radii), std::max(0.0, cores.upper - radii)};
}

}  // namespace opponens::robot
