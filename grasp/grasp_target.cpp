// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_target.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "core/require.hpp"
#include "robot/mesh.hpp"

namespace opponens::grasp {
namespace {

constexpr double kGridSpacing = 0.003;  // m
constexpr double kGridMargin = 0.03;    // m
constexpr std::size_t kGridNodes = 150000;
constexpr double kObstacleSpacing = 0.016;   // m
constexpr double kObstacleGridMargin = 0.2;  // m, around the object: where hands that hold it are
constexpr double kObstacleHorizon = 0.06;    // m, farther ones need not be told exactly
constexpr double kSurfaceSpacing = 0.0025;   // m
constexpr double kSurfacePoints = 40000.0;

/// Principal axes of the surface's second moments about its centre, the longest last. Exact: the integral of x x' over
/// a triangle of area A and corners a, b, c is A (aa' + bb' + cc' + ss') / 12 with s = a + b + c.
Eigen::Matrix3d principal_axes(const robot::TriangleMesh& mesh) {
  double area = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& triangle : mesh.triangles.colwise()) {
    const Eigen::Matrix3d corners = mesh.vertices(Eigen::all, triangle);
    const Eigen::Vector3d sum = corners.rowwise().sum();
    const double own = 0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).norm();
    area += own;
    first += own / 3.0 * sum;
    second += own / 12.0 * (corners * corners.transpose() + sum * sum.transpose());
  }
  const Eigen::Matrix3d moments = second / area - first * first.transpose() / (area * area);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors();
}

}  // namespace

robot::MeshDistance::Query GraspTarget::nearest(const Eigen::Vector3d& p_O) const {
  return distance->query(p_O, std::abs(grid->value(p_O)) + grid->error());
}

SignedDistance GraspTarget::obstacle_distance(const Eigen::Vector3d& p_O, double horizon) const {
  if (obstacle_grid && obstacle_grid->holds(p_O)) {
    const double least = obstacle_grid->value(p_O) - obstacle_grid->error();
    if (least >= horizon) return {least, obstacle_grid->query(p_O).gradient};
  }
  SignedDistance nearest{std::numeric_limits<double>::infinity(), Eigen::Vector3d::UnitZ()};
  for (const Obstacle& obstacle : obstacles) {
    // What is beyond the nearest so far need not be known exactly.
    const SignedDistance d =
        obstacle.distance.query(obstacle.X_BO * p_O, std::max(0.0, std::min(horizon, nearest.value)));
    if (d.value < nearest.value) nearest = {d.value, obstacle.X_BO.linear().transpose() * d.gradient};
  }
  return nearest;
}

GraspTarget make_target(const robot::Scene& scene, const std::string& object, int threads) {
  const robot::SceneBody& body = scene.body(object);
  require(!body.geometry.empty(), "grasp search: object " + object + " has no geometry");
  GraspTarget target;
  target.name = object;
  target.X_WO = body.X_WB;
  target.mesh = std::make_shared<const robot::TriangleMesh>(robot::merge(body.geometry));
  target.distance = std::make_shared<const robot::MeshDistance>(target.mesh);
  target.grid = std::make_shared<const DistanceGrid>(
      *target.distance, DistanceGrid::Layout{kGridSpacing, kGridMargin, kGridNodes}, threads);
  const Eigen::Matrix3Xd& vertices = target.mesh->vertices;
  const auto count = target.mesh->triangles.cols();
  target.cumulative_area.resize(count);
  double area = 0.0;
  for (Eigen::Index f = 0; f < count; ++f) {
    const Eigen::Vector3i t = target.mesh->triangles.col(f);
    area += 0.5 * (vertices.col(t[1]) - vertices.col(t[0])).cross(vertices.col(t[2]) - vertices.col(t[0])).norm();
    target.cumulative_area[f] = area;
  }
  require(area > 0.0, "grasp search: object " + object + " has no surface");
  const double spacing = std::max(kSurfaceSpacing, std::sqrt(area / kSurfacePoints));
  target.surface = PointTree(robot::surface_samples({target.mesh, Eigen::Isometry3d::Identity()}, spacing));
  target.center_of_mass = robot::is_closed(*target.mesh) ? robot::mass_properties(*target.mesh).center_of_mass
                                                         : Eigen::Vector3d(vertices.rowwise().mean());
  target.axes = principal_axes(*target.mesh);
  target.rho = (vertices.colwise() - target.center_of_mass).colwise().norm().maxCoeff();
  for (const robot::SceneBody& other : scene.bodies) {
    if (other.name == object || other.geometry.empty()) continue;
    target.obstacles.push_back({other.name, BodyDistance(other.geometry), other.X_WB.inverse() * target.X_WO});
  }
  if (!target.obstacles.empty()) {
    const Eigen::AlignedBox3d box(vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff());
    target.obstacle_grid = std::make_shared<const DistanceGrid>(
        [&target](const Eigen::Vector3d& p) { return target.obstacle_distance(p, kObstacleHorizon).value; }, box,
        DistanceGrid::Layout{kObstacleSpacing, kObstacleGridMargin, kGridNodes}, threads);
  }
  return target;
}

QualityConvention default_convention(const GraspTarget& target, double mu, int edges) {
  QualityConvention convention;
  convention.mu = mu;
  convention.edges = edges;
  convention.rho = target.rho;
  convention.origin = target.center_of_mass;
  return convention;
}

SurfaceSeed sample_surface(const GraspTarget& target, Rng& rng) {
  const Eigen::VectorXd& areas = target.cumulative_area;
  const double pick = rng.uniform() * areas[areas.size() - 1];
  const auto f =
      std::min<Eigen::Index>(std::upper_bound(areas.begin(), areas.end(), pick) - areas.begin(), areas.size() - 1);
  const Eigen::Vector3i t = target.mesh->triangles.col(f);
  const Eigen::Vector3d a = target.mesh->vertices.col(t[0]);
  const Eigen::Vector3d u = target.mesh->vertices.col(t[1]) - a;
  const Eigen::Vector3d v = target.mesh->vertices.col(t[2]) - a;
  const double root = std::sqrt(rng.uniform());
  const double share = rng.uniform();
  const double b = root * (1.0 - share);
  const double c = root * share;
  return {a + b * u + c * v, u.cross(v).normalized()};
}

SurfaceSeed sample_axis(const GraspTarget& target, Rng& rng) {
  const auto axis = static_cast<Eigen::Index>(rng.index(3));
  const Eigen::Vector3d n = rng.uniform() < 0.5 ? target.axes.col(axis).eval() : (-target.axes.col(axis)).eval();
  const Eigen::Vector3d along = target.axes.col(2);
  Eigen::Vector3d middle = target.center_of_mass;
  if (axis != 2) middle += along * along.dot(sample_surface(target, rng).p_O - middle);
  return {target.distance->query(middle + (target.rho + 0.1) * n).point, n};
}

}  // namespace opponens::grasp
