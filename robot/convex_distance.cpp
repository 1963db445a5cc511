// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

constexpr int kMaxIterations = 20000;

/// Nearest point of the shape to p, in its own frame.
Eigen::Vector3d project(const Shape& shape, const Eigen::Vector3d& p) {
  if (const auto* box = std::get_if<Box>(&shape)) return p.cwiseMax(-0.5 * box->size).cwiseMin(0.5 * box->size);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    const double norm = p.norm();
    return norm > sphere->radius ? Eigen::Vector3d(p * (sphere->radius / norm)) : p;
  }
  const auto& cylinder = std::get<Cylinder>(shape);
  Eigen::Vector3d q = p;
  const double norm = p.head<2>().norm();
  if (norm > cylinder.radius) q.head<2>() *= cylinder.radius / norm;
  q.z() = std::clamp(q.z(), -0.5 * cylinder.length, 0.5 * cylinder.length);
  return q;
}

/// max n . x over the shape, in its own frame.
double support(const Shape& shape, const Eigen::Vector3d& n) {
  if (const auto* box = std::get_if<Box>(&shape)) return 0.5 * box->size.dot(n.cwiseAbs());
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius * n.norm();
  const auto& cylinder = std::get<Cylinder>(shape);
  return cylinder.radius * n.head<2>().norm() + 0.5 * cylinder.length * std::abs(n.z());
}

}  // namespace

ConvexDistance convex_distance(const Shape& a, const Eigen::Isometry3d& X_WA, const Shape& b,
                               const Eigen::Isometry3d& X_WB, double tolerance) {
  require(!std::holds_alternative<std::shared_ptr<const TriangleMesh>>(a) &&
              !std::holds_alternative<std::shared_ptr<const TriangleMesh>>(b),
          "convex_distance: meshes are not convex");
  // Everything in the frame of A; y is the point of B, z the extrapolated one.
  const Eigen::Isometry3d X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  const Eigen::Isometry3d X_BA = X_AB.inverse(Eigen::Isometry);
  Eigen::Vector3d y = X_AB * project(b, X_BA * Eigen::Vector3d::Zero());
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

}  // namespace opponens::robot
