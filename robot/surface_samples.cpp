// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

#include "core/require.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {

namespace {

/// Keeps points that are at least `distance` apart, in the order given, by a hash grid with that cell size.
class Thinning {
 public:
  explicit Thinning(double distance) : distance_(distance) {}

  void add(const Eigen::Vector3d& p) {
    const Eigen::Array3d cell = (p.array() / distance_).floor();
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          if (near_in_cell(cell + Eigen::Array3d(dx, dy, dz), p)) return;
        }
      }
    }
    cells_[key(cell)].push_back(static_cast<int>(points.size()));
    points.push_back(p);
  }

  std::vector<Eigen::Vector3d> points;

 private:
  using Key = std::array<std::int64_t, 3>;
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      std::uint64_t hash = 0xcbf29ce484222325ULL;
      for (const std::int64_t i : k) hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15ULL;
      return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
  };

  static Key key(const Eigen::Array3d& cell) {
    return {static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
            static_cast<std::int64_t>(cell.z())};
  }

  bool near_in_cell(const Eigen::Array3d& cell, const Eigen::Vector3d& p) const {
    const auto found = cells_.find(key(cell));
    if (found == cells_.end()) return false;
    return std::any_of(found->second.begin(), found->second.end(), [&](int i) {
      return (points[static_cast<std::size_t>(i)] - p).squaredNorm() < distance_ * distance_;
    });
  }

  double distance_;
  std::unordered_map<Key, std::vector<int>, KeyHash> cells_;
};

/// Segments around a circle so that a chord is at most `chord` long.
int segments_for(double radius, double chord) {
  const double half = std::min(1.0, 0.5 * chord / radius);
  return std::max(6, static_cast<int>(std::ceil(std::numbers::pi / std::asin(half))));
}

TriangleMesh fine_mesh(const Shape& shape, double step) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return triangulate(shape, segments_for(sphere->radius, step));
  if (const auto* c = std::get_if<Cylinder>(&shape)) return triangulate(shape, segments_for(c->radius, step));
  return triangulate(shape);
}

/// Moves a point of the inscribed triangulation out to the curved surface.
Eigen::Vector3d onto_surface(const Shape& shape, const Eigen::Vector3d& p) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.normalized() * sphere->radius;
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    if (std::abs(p.z()) < 0.5 * c->length * (1.0 - 1e-12)) {
      const double factor = c->radius / p.head<2>().norm();
      return {p.x() * factor, p.y() * factor, p.z()};
    }
  }
  return p;
}

}  // namespace

std::vector<Eigen::Vector3d> surface_samples(const Geometry& geometry, double spacing) {
  require(std::isfinite(spacing) && spacing > 0.0, "surface_samples: spacing must be positive");
  // Lattice triangles have edges <= spacing / 2, so a surface point is within 0.29 spacing of a lattice point (Jung's
  // theorem), which is within 0.5 spacing of one that the thinning keeps.
  const double step = 0.5 * spacing;
  const TriangleMesh mesh = fine_mesh(geometry.shape, step);
  Thinning thinning(step);
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f));
    const Eigen::Vector3d ab = mesh.vertices.col(mesh.triangles(1, f)) - a;
    const Eigen::Vector3d ac = mesh.vertices.col(mesh.triangles(2, f)) - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(longest / step)));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        thinning.add(onto_surface(geometry.shape, a + ab * (double(i) / n) + ac * (double(j) / n)));
      }
    }
  }
  for (Eigen::Vector3d& p : thinning.points) p = geometry.X_BG * p;
  return std::move(thinning.points);
}

}  // namespace opponens::robot
