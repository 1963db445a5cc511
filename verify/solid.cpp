// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "robot/mesh.hpp"
#include "verify/nonnegative_least_squares.hpp"

namespace opponens::verify {
namespace {

using MeshPointer = std::shared_ptr<const robot::TriangleMesh>;

MeshPointer triangles_of(const robot::Shape& shape) {
  if (const auto* mesh = std::get_if<MeshPointer>(&shape)) return *mesh;
  return std::make_shared<const robot::TriangleMesh>(circumscribed(shape));
}

/// Least distance of the planes of the faces from the origin; only of those along z when `sides`.
double inner_radius(const robot::TriangleMesh& mesh, bool sides) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(triangle[0]);
    const Eigen::Vector3d n =
        (mesh.vertices.col(triangle[1]) - a).cross(Eigen::Vector3d(mesh.vertices.col(triangle[2]) - a)).normalized();
    if (!sides || std::abs(n.z()) < 0.5) least = std::min(least, n.dot(a));
  }
  return least;
}

/// Directions without a relation to axes or to each other; the next is tried when a ray grazes an edge.
const std::array<Eigen::Vector3d, 6> kDirections = {
    Eigen::Vector3d(0.5257311, 0.3141593, 0.7906277),   Eigen::Vector3d(-0.4142136, 0.7320508, 0.5411961),
    Eigen::Vector3d(0.1732051, -0.9123106, 0.3711537),  Eigen::Vector3d(-0.6180340, -0.5772157, -0.5337341),
    Eigen::Vector3d(0.8660254, -0.2718282, -0.4193150), Eigen::Vector3d(-0.1010101, 0.4669202, -0.8785240)};

}  // namespace

robot::TriangleMesh circumscribed(const robot::Shape& shape, double tolerance) {
  const auto* sphere = std::get_if<robot::Sphere>(&shape);
  const auto* cylinder = std::get_if<robot::Cylinder>(&shape);
  if (sphere == nullptr && cylinder == nullptr) return robot::triangulate(shape);
  const double radius = sphere != nullptr ? sphere->radius : cylinder->radius;
  constexpr int kMostSegments = 512;
  // 1 - cos(pi / n) of the radius is missing around, and about as much again along a sphere's meridians.
  const double estimate = std::numbers::pi * std::sqrt(radius / tolerance * (sphere != nullptr ? 1.0 : 0.5));
  for (int segments = std::clamp(static_cast<int>(estimate), 16, kMostSegments);; segments += 2) {
    robot::TriangleMesh mesh = robot::triangulate(shape, segments);
    // Two parts in 1e12 for what rounding takes away.
    const double factor = radius / inner_radius(mesh, sphere == nullptr) * (1.0 + 2e-12);
    if (radius * (factor - 1.0) > tolerance && segments < kMostSegments) continue;
    mesh.vertices.topRows<2>() *= factor;
    if (sphere != nullptr) mesh.vertices.row(2) *= factor;
    return mesh;
  }
}

Solid::Solid(const robot::Shape& shape) : mesh_(triangles_of(shape)), tree_(*mesh_), closed_(robot::is_closed(*mesh_)) {
  for (const auto& vertex : mesh_->vertices.colwise()) bounds_.extend(vertex);
  const std::vector<int> seeds = robot::component_seeds(*mesh_);
  component_points_ = mesh_->vertices(Eigen::all, seeds);
}

Solid::Crossing Solid::crossing(int triangle, const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const {
  // Moeller and Trumbore 1997, doi:10.1080/10867651.1997.10487468.
  const Eigen::Matrix3d corner = tree_.corners(triangle);
  const Eigen::Vector3d a = corner.col(0);
  const Eigen::Vector3d e1 = corner.col(1) - a;
  const Eigen::Vector3d e2 = corner.col(2) - a;
  const Eigen::Vector3d across = direction.cross(e2);
  const double determinant = e1.dot(across);
  constexpr double kEdge = 1e-10;
  if (std::abs(determinant) <= 1e-14 * e1.norm() * e2.norm()) {
    // Parallel to the ray: harmless unless the ray runs in its plane.
    const Eigen::Vector3d n = e1.cross(e2);
    return std::abs(n.dot(p - a)) <= kEdge * n.norm() ? Crossing::unclear : Crossing::none;
  }
  const Eigen::Vector3d s = p - a;
  const Eigen::Vector3d r = s.cross(e1);
  const double u = s.dot(across) / determinant;
  const double v = direction.dot(r) / determinant;
  if (u < -kEdge || v < -kEdge || u + v > 1.0 + kEdge) return Crossing::none;
  const double t = e2.dot(r) / determinant;
  if (t < 0.0) return Crossing::none;
  if (u < kEdge || v < kEdge || u + v > 1.0 - kEdge) return Crossing::unclear;
  return determinant > 0.0 ? Crossing::in : Crossing::out;
}

std::optional<int> Solid::winding(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const {
  int sum = 0;
  for (std::size_t i = 0; i < tree_.balls().size();) {
    const BallTree::Ball& ball = tree_.balls()[i];
    const Eigen::Vector3d to = ball.center - p;
    const double along = to.dot(direction);
    // A little more than the ball, for rays that graze.
    const double reach = ball.radius * (1.0 + 1e-9);
    if (to.squaredNorm() - along * along > reach * reach || along < -reach) {
      i = static_cast<std::size_t>(ball.next);
      continue;
    }
    for (int k = ball.begin; ball.leaf && k < ball.end; ++k) {
      switch (crossing(tree_.order()[static_cast<std::size_t>(k)], p, direction)) {
        case Crossing::in:
          ++sum;
          break;
        case Crossing::out:
          --sum;
          break;
        case Crossing::unclear:
          return std::nullopt;
        case Crossing::none:
          break;
      }
    }
    ++i;
  }
  return sum;
}

bool Solid::inside(const Eigen::Vector3d& p) const {
  if (!closed_ || !bounds_.contains(p)) return false;
  for (const Eigen::Vector3d& direction : kDirections) {
    if (const auto sum = winding(p, direction.normalized())) return *sum != 0;
  }
  // Every ray met an edge: only a point on the surface itself does that.
  return false;
}

double Solid::normal_angle(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double reach) const {
  std::vector<Eigen::Vector3d> normals;
  double least = std::numbers::pi;
  for (int i = 0; i < static_cast<int>(mesh_->triangles.cols()); ++i) {
    const Eigen::Matrix3d corner = tree_.corners(i);
    const Eigen::Vector3d n = (corner.col(1) - corner.col(0)).cross(Eigen::Vector3d(corner.col(2) - corner.col(0)));
    if (n.norm() == 0.0 || triangle_distance(corner, p) > reach) continue;
    normals.push_back(n.normalized());
    least = std::min(least, std::atan2(n.cross(direction).norm(), n.dot(direction)));
  }
  if (normals.empty()) return least;
  Eigen::MatrixXd N(3, static_cast<Eigen::Index>(normals.size()));
  for (std::size_t i = 0; i < normals.size(); ++i) N.col(static_cast<Eigen::Index>(i)) = normals[i];
  const Eigen::Vector3d nearest = N * nonnegative_least_squares(N, direction.normalized()).x;
  // Outside the polar cone the projection is nearer than any one normal; inside it, it is zero and says nothing.
  if (nearest.norm() < 1e-12) return least;
  return std::min(least, std::atan2((direction.normalized() - nearest).norm(), nearest.norm()));
}

}  // namespace opponens::verify
