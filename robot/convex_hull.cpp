// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_hull.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include "core/require.hpp"
#include "robot/quickhull.hpp"

namespace opponens::robot {

namespace {

constexpr int kPadding = 8;
constexpr Eigen::Index kFew = 64;  ///< points that are searched at once

/// Indices of the hull's vertices; nullopt when qhull finds no volume.
std::optional<std::vector<Eigen::Index>> solid_hull_indices(const Eigen::Matrix3Xd& points) {
  const auto hull = Quickhull::build(points, "Qt");
  if (!hull) return std::nullopt;
  return hull->vertices();
}

/// A point off the plane of points that span one: with it they span a volume. nullopt when they lie on a line.
std::optional<Eigen::Vector3d> apex_over(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d a = points.col(0);
  Eigen::Index far = 0;
  const double length = (points.colwise() - a).colwise().norm().maxCoeff(&far);
  const Eigen::Vector3d along = points.col(far) - a;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const auto& p : points.colwise()) {
    const Eigen::Vector3d n = along.cross(p - a);
    if (n.squaredNorm() > normal.squaredNorm()) normal = n;
  }
  constexpr double kLine = 1e-6;  // of its length
  if (!(normal.norm() > kLine * length * length)) return std::nullopt;
  return points.rowwise().mean() + length * normal.normalized();
}

PaddedPoints padded(const Eigen::Matrix3Xd& points) {
  PaddedPoints padded;
  padded.count = (static_cast<int>(points.cols()) + kPadding - 1) / kPadding * kPadding;
  const auto count = static_cast<std::size_t>(padded.count);
  padded.xyz.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto source = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d p = points.col(source < points.cols() ? source : 0);
    for (std::size_t k = 0; k < 3; ++k) padded.xyz[k * count + i] = static_cast<float>(p[static_cast<Eigen::Index>(k)]);
  }
  return padded;
}

/// Those farthest towards the middles of a cube's faces, edges and corners.
Eigen::Matrix3Xd farthest_all_around(const Eigen::Matrix3Xd& points) {
  std::set<Eigen::Index> chosen;
  for (int code = 0; code < 27; ++code) {
    const Eigen::RowVector3d n(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    Eigen::Index far = 0;
    (n * points).maxCoeff(&far);
    chosen.insert(far);
  }
  return points(Eigen::all, std::vector<Eigen::Index>(chosen.begin(), chosen.end()));
}

}  // namespace

std::vector<Eigen::Index> hull_indices(const Eigen::Matrix3Xd& points) {
  std::optional<std::vector<Eigen::Index>> found = solid_hull_indices(points);
  if (!found && points.cols() > 3) {
    if (const std::optional<Eigen::Vector3d> apex = apex_over(points)) {
      Eigen::Matrix3Xd cone(3, points.cols() + 1);
      cone << points, *apex;
      found = solid_hull_indices(cone);
      if (found) std::erase(*found, points.cols());
    }
  }
  if (!found) {
    found.emplace(static_cast<std::size_t>(points.cols()));
    std::iota(found->begin(), found->end(), 0);
  }
  std::sort(found->begin(), found->end());
  return *found;
}

HullVertices hull_vertices(const Eigen::Matrix3Xd& points) {
  require(points.cols() > 0, "hull_vertices: no points");
  HullVertices hull{padded(points), {}, 0.0};
  if (points.cols() > kFew) hull.few = padded(farthest_all_around(points));
  // Of storing, of qhull's merged facets, and of the farthest vertex found in single precision.
  hull.rounding = 16.0 * std::numeric_limits<float>::epsilon() * points.cwiseAbs().maxCoeff();
  return hull;
}

HullVertices hull_vertices(const TriangleMesh& mesh) {
  std::vector<bool> is_used(static_cast<std::size_t>(mesh.vertices.cols()), false);
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) is_used[static_cast<std::size_t>(mesh.triangles(k, f))] = true;
  }
  std::vector<Eigen::Index> used;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    if (is_used[static_cast<std::size_t>(i)]) used.push_back(i);
  }
  const Eigen::Matrix3Xd points = mesh.vertices(Eigen::all, used);
  return hull_vertices(points(Eigen::all, hull_indices(points)));
}

}  // namespace opponens::robot
