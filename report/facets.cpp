// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/facets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "core/require.hpp"

namespace opponens::report {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

/// A facet with the normal of its polygon (Newell's sum); nullopt when it has no area.
std::optional<Facet> facet(Corners corners, int paint) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) sum += corners[i].cross(corners[(i + 1) % corners.size()]);
  const double length = sum.norm();
  if (!(length > 1e-14)) return std::nullopt;  // m^2, twice the area
  return Facet{std::move(corners), sum / length, paint};
}

class Collector {
 public:
  Collector(std::vector<Facet>& out, const Eigen::Isometry3d& pose, int paint)
      : out_(out), pose_(pose), paint_(paint) {}
  void add(Corners corners) {
    for (auto& corner : corners) corner = pose_ * corner;
    if (auto made = facet(std::move(corners), paint_)) out_.push_back(std::move(*made));
  }

 private:
  std::vector<Facet>& out_;
  const Eigen::Isometry3d& pose_;
  int paint_;
};

void add_box(Collector& out, const robot::Box& box) {
  const Eigen::Vector3d half = 0.5 * box.size;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      Corners corners;
      for (const auto& [a, b] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
        Eigen::Vector3d p;
        p[axis] = side * half[axis];
        p[u] = side * a * half[u];  // mirrored on the far side, so that both wind outward
        p[v] = b * half[v];
        corners.push_back(p);
      }
      out.add(std::move(corners));
    }
  }
}

Eigen::Vector3d ring_point(double radius, double height, int i, int count) {
  const double angle = 2.0 * std::numbers::pi * i / count;
  return {radius * std::cos(angle), radius * std::sin(angle), height};
}

/// A band of quadrilaterals between two rings about z.
void add_band(Collector& out, double r0, double z0, double r1, double z1, int around) {
  for (int i = 0; i < around; ++i) {
    out.add({ring_point(r0, z0, i, around), ring_point(r0, z0, i + 1, around), ring_point(r1, z1, i + 1, around),
             ring_point(r1, z1, i, around)});
  }
}

void add_cylinder(Collector& out, const robot::Cylinder& cylinder, int around) {
  const double half = 0.5 * cylinder.length;
  add_band(out, cylinder.radius, -half, cylinder.radius, half, around);
  Corners top;
  Corners bottom;
  for (int i = 0; i < around; ++i) {
    top.push_back(ring_point(cylinder.radius, half, i, around));
    bottom.push_back(ring_point(cylinder.radius, -half, around - i, around));
  }
  out.add(std::move(top));
  out.add(std::move(bottom));
}

void add_sphere(Collector& out, const robot::Sphere& sphere, int around) {
  const int bands = std::max(4, around / 2);
  const auto angle = [&](int i) { return std::numbers::pi * (static_cast<double>(i) / bands - 0.5); };
  for (int i = 0; i < bands; ++i) {
    const double low = angle(i);
    const double high = angle(i + 1);
    add_band(out, sphere.radius * std::cos(low), sphere.radius * std::sin(low), sphere.radius * std::cos(high),
             sphere.radius * std::sin(high), around);
  }
}

/// Six times the signed volume.
double volume_sign(const robot::TriangleMesh& mesh) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    const auto t = mesh.triangles.col(i);
    sum += mesh.vertices.col(t[0]).dot(mesh.vertices.col(t[1]).cross(mesh.vertices.col(t[2])));
  }
  return sum;
}

void add_mesh(Collector& out, const robot::TriangleMesh& mesh, int max_triangles) {
  const robot::TriangleMesh coarse = simplified(mesh, max_triangles);
  const bool turn = volume_sign(mesh) < 0.0;
  for (Eigen::Index i = 0; i < coarse.triangles.cols(); ++i) {
    const auto t = coarse.triangles.col(i);
    out.add({coarse.vertices.col(t[0]), coarse.vertices.col(t[turn ? 2 : 1]), coarse.vertices.col(t[turn ? 1 : 2])});
  }
}

robot::TriangleMesh clustered(const robot::TriangleMesh& mesh, double cell) {
  const Eigen::Vector3d corner = mesh.vertices.rowwise().minCoeff();
  std::map<std::array<int, 3>, int> cells;
  std::vector<int> cluster(static_cast<std::size_t>(mesh.vertices.cols()));
  std::vector<Eigen::Vector4d> sums;  // position sum and count
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    const Eigen::Vector3i at = ((mesh.vertices.col(i) - corner) / cell).array().floor().cast<int>();
    const auto [found, fresh] = cells.try_emplace({at[0], at[1], at[2]}, static_cast<int>(sums.size()));
    if (fresh) sums.emplace_back(Eigen::Vector4d::Zero());
    sums[static_cast<std::size_t>(found->second)] += mesh.vertices.col(i).homogeneous();
    cluster[static_cast<std::size_t>(i)] = found->second;
  }
  robot::TriangleMesh result;
  result.source = mesh.source;
  result.vertices.resize(3, static_cast<Eigen::Index>(sums.size()));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    result.vertices.col(static_cast<Eigen::Index>(i)) = sums[i].hnormalized();
  }
  std::map<std::array<int, 3>, Eigen::Vector3i> kept;  // smallest index first: one triangle per direction and place
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    Eigen::Vector3i t;
    for (int c = 0; c < 3; ++c) t[c] = cluster[static_cast<std::size_t>(mesh.triangles(c, i))];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    while (t[0] > t[1] || t[0] > t[2]) t = Eigen::Vector3i(t[1], t[2], t[0]);
    kept.try_emplace({t[0], t[1], t[2]}, t);
  }
  result.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
  Eigen::Index column = 0;
  for (const auto& [key, triangle] : kept) result.triangles.col(column++) = triangle;
  return result;
}

}  // namespace

robot::TriangleMesh simplified(const robot::TriangleMesh& mesh, int max_triangles) {
  require(max_triangles >= 12, "a simplified mesh needs at least 12 triangles");
  if (mesh.triangles.cols() <= max_triangles || mesh.vertices.cols() == 0) return mesh;
  const double extent = (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).maxCoeff();
  // A grid of c cells a side leaves about 4 c^2 triangles of a box-like surface; the search starts above that.
  int cells = 2 + static_cast<int>(std::sqrt(static_cast<double>(max_triangles)));
  robot::TriangleMesh coarse = clustered(mesh, extent / cells * (1.0 + 1e-9));
  while (coarse.triangles.cols() > max_triangles && cells > 1) {
    --cells;
    coarse = clustered(mesh, extent / cells * (1.0 + 1e-9));
  }
  return coarse;
}

std::vector<Facet> facets(const robot::Geometry& geometry, int paint, const FacetDetail& detail) {
  std::vector<Facet> out;
  Collector collector(out, geometry.X_BG, paint);
  if (const auto* box = std::get_if<robot::Box>(&geometry.shape)) {
    add_box(collector, *box);
  } else if (const auto* cylinder = std::get_if<robot::Cylinder>(&geometry.shape)) {
    add_cylinder(collector, *cylinder, detail.around);
  } else if (const auto* sphere = std::get_if<robot::Sphere>(&geometry.shape)) {
    add_sphere(collector, *sphere, detail.around);
  } else if (const auto& mesh = std::get<std::shared_ptr<const robot::TriangleMesh>>(geometry.shape)) {
    add_mesh(collector, *mesh, detail.max_triangles);
  }
  return out;
}

void append(std::vector<Facet>& out, const std::vector<Facet>& source, const Eigen::Isometry3d& X_WB) {
  for (const auto& from : source) {
    Facet moved{{}, X_WB.linear() * from.normal, from.paint};
    moved.corners.reserve(from.corners.size());
    for (const auto& corner : from.corners) moved.corners.push_back(X_WB * corner);
    out.push_back(std::move(moved));
  }
}

}  // namespace opponens::report
