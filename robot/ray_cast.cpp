// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/ray_cast.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <variant>

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-9;  ///< m, hits nearer than this to each other are one

/// Keeps the nearest hit of those offered.
class Nearest {
 public:
  explicit Nearest(const Vector3d& direction) : direction_(direction) {}

  void offer(double distance, const Vector3d& normal) {
    if (!(distance >= 0.0) || !std::isfinite(distance)) return;
    const double facing = std::abs(normal.dot(direction_));
    if (distance > hit_.distance + kSame) return;
    if (distance > hit_.distance - kSame && facing <= facing_) return;
    facing_ = facing;
    hit_ = {distance, normal.dot(direction_) > 0.0 ? Vector3d(-normal) : normal};
  }
  std::optional<RayHit> hit() const { return std::isfinite(hit_.distance) ? std::optional(hit_) : std::nullopt; }

 private:
  Vector3d direction_;
  RayHit hit_{std::numeric_limits<double>::infinity(), Vector3d::Zero()};
  double facing_ = 0.0;
};

void meet(const Box& box, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) continue;
    for (const double side : {-0.5, 0.5}) {
      const double t = (side * box.size[axis] - o[axis]) / d[axis];
      const Eigen::Array3d p = (o + t * d).array().abs();
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      if (p[u] <= 0.5 * box.size[u] && p[v] <= 0.5 * box.size[v]) {
        nearest.offer(t, (side < 0.0 ? -1.0 : 1.0) * Vector3d::Unit(axis));
      }
    }
  }
}

void meet(const Sphere& sphere, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  const double b = o.dot(d);
  const double discriminant = b * b - o.squaredNorm() + sphere.radius * sphere.radius;
  if (discriminant < 0.0) return;
  for (const double root : {-std::sqrt(discriminant), std::sqrt(discriminant)}) {
    const double t = root - b;
    nearest.offer(t, (o + t * d) / sphere.radius);
  }
}

void meet(const Cylinder& cylinder, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  const double a = d.head<2>().squaredNorm();
  const double b = o.head<2>().dot(d.head<2>());
  const double c = o.head<2>().squaredNorm() - cylinder.radius * cylinder.radius;
  if (a > 0.0 && b * b >= a * c) {
    for (const double root : {-std::sqrt(b * b - a * c), std::sqrt(b * b - a * c)}) {
      const double t = (root - b) / a;
      const Vector3d p = o + t * d;
      if (std::abs(p.z()) > 0.5 * cylinder.length) continue;
      nearest.offer(t, Vector3d(p.x(), p.y(), 0.0) / cylinder.radius);
    }
  }
  if (d.z() == 0.0) return;
  for (const double side : {-1.0, 1.0}) {
    const double t = (side * 0.5 * cylinder.length - o.z()) / d.z();
    if ((o + t * d).head<2>().norm() <= cylinder.radius) nearest.offer(t, side * Vector3d::UnitZ());
  }
}

void meet(const std::shared_ptr<const TriangleMesh>& mesh, const Vector3d& o, const Vector3d& d, Nearest& nearest) {
  constexpr double kEdge = 1e-12;  // of the barycentric coordinates: a ray through an edge meets both triangles
  for (Eigen::Index i = 0; i < mesh->triangles.cols(); ++i) {
    const Vector3d p = mesh->vertices.col(mesh->triangles(0, i));
    const Vector3d e1 = mesh->vertices.col(mesh->triangles(1, i)) - p;
    const Vector3d e2 = mesh->vertices.col(mesh->triangles(2, i)) - p;
    const Vector3d h = d.cross(e2);
    const double determinant = e1.dot(h);
    if (determinant == 0.0) continue;
    const Vector3d s = o - p;
    const double u = s.dot(h) / determinant;
    if (u < -kEdge || u > 1.0 + kEdge) continue;
    const Vector3d r = s.cross(e1);
    const double v = d.dot(r) / determinant;
    if (v < -kEdge || u + v > 1.0 + kEdge) continue;
    const Vector3d normal = e1.cross(e2);
    if (normal.norm() > 0.0) nearest.offer(e2.dot(r) / determinant, normal.normalized());
  }
}

}  // namespace

std::optional<RayHit> first_hit(const Geometry& geometry, const Vector3d& origin, const Vector3d& direction) {
  const Eigen::Isometry3d X_GB = geometry.X_BG.inverse();
  const Vector3d o = X_GB * origin;
  const Vector3d d = X_GB.linear() * direction;
  Nearest nearest(d);
  std::visit([&](const auto& shape) { meet(shape, o, d, nearest); }, geometry.shape);
  std::optional<RayHit> hit = nearest.hit();
  if (hit) hit->normal = geometry.X_BG.linear() * hit->normal;
  return hit;
}

}  // namespace opponens::robot
