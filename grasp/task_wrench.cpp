// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/task_wrench.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "grasp/six_row_simplex.hpp"

namespace opponens::grasp {
namespace {

constexpr double kGravity = 9.80665;    // m/s^2, standard
constexpr double kRayGap = 1e-9;        // relative, of sets of points
constexpr double kRaySeparated = 1e-9;  // of the scale: a direction separates when the set does not pass it by more
constexpr int kMaxRayPoints = 5000;

/// One answer of the programme over some points of the set.
struct Ray {
  bool reached = false;  // the load is a nonnegative combination of the points
  double total = 0.0;    // min 1'a where reached
  Vector6d dual = Vector6d::Zero();
  bool converged = true;
};

Ray cast_ray(const Matrix6Xd& points, const Vector6d& load) {
  SixRowSimplex simplex(points, load);
  Ray ray;
  const std::optional<bool> feasible = simplex.feasible();
  ray.reached = feasible.value_or(false);
  ray.converged = feasible.has_value() && (!ray.reached || simplex.optimize());
  for (int row = 0; row < 6; ++row) ray.total += simplex.basis()[row] < 0 ? 0.0 : std::max(simplex.value()[row], 0.0);
  ray.dual = simplex.dual();
  return ray;
}

}  // namespace

LoadFactor load_factor(const WrenchSpace& space, const Vector6d& load, double relative_gap) {
  require(load.allFinite() && load.norm() > 0.0, "load_factor: the load must be finite and not zero");
  require(!space.curved() || relative_gap > 0.0, "load_factor: a curved set needs a relative_gap > 0");
  const double gap = std::max(relative_gap, kRayGap);
  const double unit = 1.0 / space.scale();
  const Vector6d toward = load.normalized();
  Matrix6Xd points = unit * space.wrenches();
  LoadFactor result;
  result.upper = std::numeric_limits<double>::infinity();
  result.converged = false;
  while (points.cols() < space.wrenches().cols() + kMaxRayPoints) {
    const Ray ray = cast_ray(points, toward);
    if (!ray.converged) break;
    const Vector6d p = unit * space.support(ray.dual);
    const double beyond = ray.dual.dot(p);
    if (!ray.reached) {
      // The dual separates the load from the points; where no point of the set passes it either, from the set.
      result.converged = beyond <= kRaySeparated * ray.dual.norm();
      if (result.converged) {
        result.upper = 0.0;
        result.direction = ray.dual.normalized();
      }
      if (result.converged) break;
    } else {
      const double scale = space.scale() / load.norm();
      result.factor = std::max(result.factor, scale / ray.total);
      if (const double upper = scale * std::max(beyond, 1.0) / ray.total; upper < result.upper) {
        result.upper = upper;
        result.direction = ray.dual.normalized();
      }
      result.converged = result.upper <= (1.0 + gap) * result.factor;
      if (result.converged) break;
    }
    points.conservativeResize(6, points.cols() + 1);
    points.rightCols<1>() = p;
  }
  return result;
}

TaskQuality task_quality(const WrenchSpace& space, const Matrix6Xd& loads, double relative_gap) {
  require(loads.cols() > 0, "task_quality: there must be at least one load");
  TaskQuality task;
  for (Eigen::Index j = 0; j < loads.cols(); ++j) {
    const LoadFactor found = load_factor(space, loads.col(j), relative_gap);
    if (j > 0 && found.factor >= task.least.factor) continue;
    task.least = found;
    task.limiting = j;
  }
  return task;
}

Vector6d load_against(const Eigen::Vector3d& force, const Eigen::Vector3d& torque,
                      const QualityConvention& convention) {
  Vector6d load;
  load << -force, -torque / convention.rho;
  return load;
}

Vector6d load_against_gravity(double mass, const Eigen::Vector3d& p_OM, const Eigen::Vector3d& down,
                              const QualityConvention& convention) {
  require(mass >= 0.0 && std::isfinite(mass), "load_against_gravity: mass must be >= 0, got " + std::to_string(mass));
  require(down.allFinite() && down.norm() > 0.0, "load_against_gravity: `down` must be finite and not zero");
  const Eigen::Vector3d force = mass * kGravity * down.normalized();
  return load_against(force, (p_OM - convention.origin).cross(force), convention);
}

}  // namespace opponens::grasp
