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

robot::TriangleMesh triangles_of(const robot::Shape& shape) {
  const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&shape);
  return mesh != nullptr ? **mesh : robot::triangulate(shape, 64);
}

/// Directions without a relation to axes or to each other; the next is tried when a ray grazes an edge.
const std::array<Eigen::Vector3d, 6> kDirections = {
    Eigen::Vector3d(0.5257311, 0.3141593, 0.7906277),   Eigen::Vector3d(-0.4142136, 0.7320508, 0.5411961),
    Eigen::Vector3d(0.1732051, -0.9123106, 0.3711537),  Eigen::Vector3d(-0.6180340, -0.5772157, -0.5337341),
    Eigen::Vector3d(0.8660254, -0.2718282, -0.4193150), Eigen::Vector3d(-0.1010101, 0.4669202, -0.8785240)};

}  // namespace

Solid::Solid(const robot::Shape& shape) : mesh_(triangles_of(shape)), closed_(robot::is_closed(mesh_)) {
  for (const auto& vertex : mesh_.vertices.colwise()) bounds_.extend(vertex);
  const std::vector<int> seeds = robot::component_seeds(mesh_);
  component_points_ = mesh_.vertices(Eigen::all, seeds);
}

Solid::Crossing Solid::crossing(Eigen::Index triangle, const Eigen::Vector3d& p,
                                const Eigen::Vector3d& direction) const {
  // Moeller and Trumbore 1997, doi:10.1080/10867651.1997.10487468.
  const Eigen::Vector3d a = mesh_.vertices.col(mesh_.triangles(0, triangle));
  const Eigen::Vector3d e1 = mesh_.vertices.col(mesh_.triangles(1, triangle)) - a;
  const Eigen::Vector3d e2 = mesh_.vertices.col(mesh_.triangles(2, triangle)) - a;
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

bool Solid::inside(const Eigen::Vector3d& p) const {
  if (!closed_ || !bounds_.contains(p)) return false;
  int winding = 0;
  for (const Eigen::Vector3d& direction : kDirections) {
    winding = 0;
    bool clear = true;
    for (Eigen::Index i = 0; i < mesh_.triangles.cols() && clear; ++i) {
      switch (crossing(i, p, direction)) {
        case Crossing::in:
          ++winding;
          break;
        case Crossing::out:
          --winding;
          break;
        case Crossing::unclear:
          clear = false;
          break;
        case Crossing::none:
          break;
      }
    }
    if (clear) return winding != 0;
  }
  // Every ray met an edge: only a point on the surface itself does that.
  return false;
}

double Solid::triangle_distance(Eigen::Index triangle, const Eigen::Vector3d& p) const {
  const std::array<Eigen::Vector3d, 3> corner = {mesh_.vertices.col(mesh_.triangles(0, triangle)),
                                                 mesh_.vertices.col(mesh_.triangles(1, triangle)),
                                                 mesh_.vertices.col(mesh_.triangles(2, triangle))};
  const Eigen::Vector3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  bool over = n.norm() > 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = corner[i];
    const Eigen::Vector3d edge = corner[(i + 1) % 3] - a;
    if (n.cross(edge).dot(p - a) < 0.0) over = false;
    const double length = edge.squaredNorm();
    const double along = length > 0.0 ? std::clamp(edge.dot(p - a) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - along * edge).norm());
  }
  return over ? std::min(least, std::abs(n.dot(p - corner[0])) / n.norm()) : least;
}

double Solid::distance(const Eigen::Vector3d& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < mesh_.triangles.cols(); ++i) least = std::min(least, triangle_distance(i, p));
  return least;
}

double Solid::normal_angle(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double reach) const {
  std::vector<Eigen::Vector3d> normals;
  double least = std::numbers::pi;
  for (Eigen::Index i = 0; i < mesh_.triangles.cols(); ++i) {
    const Eigen::Vector3d a = mesh_.vertices.col(mesh_.triangles(0, i));
    const Eigen::Vector3d e1 = mesh_.vertices.col(mesh_.triangles(1, i)) - a;
    const Eigen::Vector3d e2 = mesh_.vertices.col(mesh_.triangles(2, i)) - a;
    const Eigen::Vector3d n = e1.cross(e2);
    if (n.norm() == 0.0 || triangle_distance(i, p) > reach) continue;
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
