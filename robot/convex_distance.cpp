// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/require.hpp"
#include "robot/bounding_volume_tree.hpp"

namespace opponens::robot {

namespace {

constexpr int kMaxIterations = 20000;

struct Triangle {
  Eigen::Vector3d a, ab, ac;
};

Eigen::Vector3d project(const Box& box, const Eigen::Vector3d& p) {
  return p.cwiseMax(-0.5 * box.size).cwiseMin(0.5 * box.size);
}
Eigen::Vector3d project(const Sphere& sphere, const Eigen::Vector3d& p) {
  const double norm = p.norm();
  return norm > sphere.radius ? Eigen::Vector3d(p * (sphere.radius / norm)) : p;
}
Eigen::Vector3d project(const Cylinder& cylinder, const Eigen::Vector3d& p) {
  Eigen::Vector3d q = p;
  const double norm = p.head<2>().norm();
  if (norm > cylinder.radius) q.head<2>() *= cylinder.radius / norm;
  q.z() = std::clamp(q.z(), -0.5 * cylinder.length, 0.5 * cylinder.length);
  return q;
}
Eigen::Vector3d project(const Triangle& t, const Eigen::Vector3d& p) {
  return nearest_on_triangle(t.a, t.ab, t.ac, p).point;
}

/// max n . x over the shape, in its own frame.
double support(const Box& box, const Eigen::Vector3d& n) { return 0.5 * box.size.dot(n.cwiseAbs()); }
double support(const Sphere& sphere, const Eigen::Vector3d& n) { return sphere.radius * n.norm(); }
double support(const Cylinder& cylinder, const Eigen::Vector3d& n) {
  return cylinder.radius * n.head<2>().norm() + 0.5 * cylinder.length * std::abs(n.z());
}

/// Distance between convex sets; A in its own frame, B at X_AB. y is the point of B, z the extrapolated one.
template <typename A, typename B>
ConvexDistance distance_between(const A& a, const B& b, const Eigen::Isometry3d& X_AB, double tolerance) {
  const Eigen::Isometry3d X_BA = X_AB.inverse(Eigen::Isometry);
  Eigen::Vector3d y = X_AB * project(b, X_BA * project(a, X_AB.translation()));
  Eigen::Vector3d z = y;
  double momentum = 1.0;
  ConvexDistance result{0.0, std::numeric_limits<double>::infinity(), 0};
  for (; result.iterations < kMaxIterations; ++result.iterations) {
    const Eigen::Vector3d x = project(a, y);
    const Eigen::Vector3d gap = y - x;
    const double distance = gap.norm();
    result.upper = std::min(result.upper, distance);
    if (distance <= tolerance) return result;
    // x is the projection of y: the plane through x across the gap has all of A behind it. How far ahead is B?
    const Eigen::Vector3d n = gap / distance;
    const double ahead = n.dot(X_AB.translation()) - support(b, -(X_AB.linear().transpose() * n)) - n.dot(x);
    result.lower = std::max(result.lower, ahead);
    if (result.upper - result.lower <= tolerance) return result;
    const Eigen::Vector3d y_next = X_AB * project(b, X_BA * project(a, z));
    const bool turned = (z - y_next).dot(y_next - y) > 0.0;
    const double momentum_next = turned ? 1.0 : 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    z = turned ? y_next : Eigen::Vector3d(y_next + (momentum - 1.0) / momentum_next * (y_next - y));
    momentum = momentum_next;
    y = y_next;
  }
  return result;
}

/// Calls use with the primitive that a shape holds.
template <typename Use>
ConvexDistance with_primitive(const Shape& shape, const Use& use) {
  if (const auto* box = std::get_if<Box>(&shape)) return use(*box);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return use(*sphere);
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  require(cylinder != nullptr, "convex_distance: meshes are not convex");
  return use(*cylinder);
}

}  // namespace

ConvexDistance convex_distance(const Shape& a, const Eigen::Isometry3d& X_WA, const Shape& b,
                               const Eigen::Isometry3d& X_WB, double tolerance) {
  const Eigen::Isometry3d X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  return with_primitive(a, [&](const auto& A) {
    return with_primitive(b, [&](const auto& B) { return distance_between(A, B, X_AB, tolerance); });
  });
}

ConvexDistance triangle_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac,
                                 const Shape& shape, const Eigen::Isometry3d& X_MS, double tolerance) {
  return with_primitive(shape, [&](const auto& S) {
    return distance_between(Triangle{a, ab, ac}, S, X_MS, tolerance);
  });
}

}  // namespace opponens::robot
