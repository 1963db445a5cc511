// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"
#include "robot/mesh_repair.hpp"

namespace opponens::robot {

namespace {

constexpr double kSpacing = 1.0 / 200.0;  ///< of the samples, of the diagonal of the surface before

using Mesh = std::shared_ptr<const TriangleMesh>;

/// Largest signed distance of the samples of one surface to another, and the largest absolute one.
std::pair<double, double> furthest(const Mesh& from, const Mesh& to, double spacing) {
  const MeshDistance distance(to);
  double outside = 0.0;
  double away = 0.0;
  for (const Eigen::Vector3d& p : surface_samples({from}, spacing)) {
    const double d = distance.signed_distance(p);
    outside = std::max(outside, d);
    away = std::max(away, std::abs(d));
  }
  return {outside, away};
}

}  // namespace

SurfaceChange surface_change(const TriangleMesh& before, const TriangleMesh& after) {
  require(before.triangles.cols() > 0 && after.triangles.cols() > 0, "surface_change: a mesh without triangles");
  const auto old_mesh = std::make_shared<const TriangleMesh>(merge_equal_vertices(before));
  const auto new_mesh = std::make_shared<const TriangleMesh>(after);
  require(old_mesh->triangles.cols() > 0, "surface_change: the mesh before has no area");
  SurfaceChange change{};
  change.spacing =
      kSpacing * (old_mesh->vertices.rowwise().maxCoeff() - old_mesh->vertices.rowwise().minCoeff()).norm();
  const auto [outside, away] = furthest(old_mesh, new_mesh, change.spacing);
  change.from_before = away;
  change.shrunk = is_closed(after) ? outside : 0.0;
  change.from_after = furthest(new_mesh, old_mesh, change.spacing).second;
  return change;
}

}  // namespace opponens::robot
