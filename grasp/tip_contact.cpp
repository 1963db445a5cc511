// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/tip_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/require.hpp"

namespace opponens::grasp {
namespace {

constexpr double kOnSphere = 0.001;    // m, a tip point this near to a sphere is on it
constexpr double kFitReach = 0.010;    // m, samples that shape the fitted ball
constexpr double kTouchReach = 0.030;  // m, samples that may touch, around the tip's centre
constexpr double kOnSurface = 1e-7;    // m, nearer: the direction from the surface is rounding, the face decides
constexpr int kProjections = 20;

/// Normal out of the object at a point at distance `gap`: the distance's gradient, the face's normal on the surface.
Eigen::Vector3d outward(const robot::MeshDistance& mesh, const robot::MeshDistance::Query& at) {
  if (std::abs(at.distance) > kOnSurface) return at.gradient;
  const Eigen::Vector3i t = mesh.mesh().triangles.col(at.triangle);
  const Eigen::Matrix3Xd& v = mesh.mesh().vertices;
  return (v.col(t[1]) - v.col(t[0])).cross(v.col(t[2]) - v.col(t[0])).normalized();
}

bool find_sphere(const robot::Link& link, const Eigen::Vector3d& p_L, FingerTip& tip) {
  for (const robot::Geometry& geometry : link.collision) {
    const auto* sphere = std::get_if<robot::Sphere>(&geometry.shape);
    if (sphere == nullptr) continue;
    const Eigen::Vector3d center = geometry.X_BG.translation();
    if (std::abs((p_L - center).norm() - sphere->radius) > kOnSphere) continue;
    tip.center_L = center;
    tip.radius = sphere->radius;
    return true;
  }
  return false;
}

double fitted_radius(const std::vector<Eigen::Vector3d>& samples, const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
  double ab = 0.0;
  double bb = 0.0;
  for (const Eigen::Vector3d& s : samples) {
    const Eigen::Vector3d away = s - p;
    if (away.norm() > kFitReach) continue;
    const double b = away.dot(n);
    ab += away.squaredNorm() * b;
    bb += b * b;
  }
  return bb > 0.0 ? std::clamp(-ab / (2.0 * bb), 0.002, 0.020) : 0.020;
}

TipTouch touch_by_samples(const FingerTip& tip, const HandSurface& surface, const GraspTarget& target,
                          const Eigen::Isometry3d& X_OL) {
  const auto link = static_cast<std::size_t>(tip.link);
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector3d q_O = X_OL * tip.center_L;  // of the tip's surface
  for (const Eigen::Vector3d& p_L : surface.shapes[link]->points.points()) {
    if ((p_L - tip.center_L).norm() > kTouchReach) continue;
    const Eigen::Vector3d p_O = X_OL * p_L;
    if (target.grid->value(p_O) - target.grid->spacing() > least) continue;
    const double d = target.distance->signed_distance(p_O);
    if (d >= least) continue;
    least = d;
    q_O = p_O;
  }
  const Eigen::Isometry3d X_LO = X_OL.inverse();
  robot::MeshDistance::Query at = target.distance->query(q_O);
  for (int i = 0; i < kProjections; ++i) {
    const Eigen::Vector3d p_L = X_LO * at.point;
    const SignedDistance d = surface.shapes[link]->body.query(p_L, 1.0);
    const Eigen::Vector3d next = X_OL * (p_L - d.value * d.gradient);
    const robot::MeshDistance::Query there = target.distance->query(next);
    if (there.distance >= at.distance - 1e-9) break;
    at = there;
  }
  return {at.distance, at.point, -outward(*target.distance, at)};
}

}  // namespace

std::vector<FingerTip> finger_tips(const robot::RobotModel& hand, const HandSurface& surface, TipModel model) {
  std::vector<FingerTip> tips;
  for (const robot::SurfacePoint& point : hand.description().tips) {
    FingerTip tip{point.finger, point.link, point.p_L, 0.0, true};
    const auto link = static_cast<std::size_t>(point.link);
    if (model == TipModel::ball && !find_sphere(hand.links()[link], point.p_L, tip)) {
      tip.radius = fitted_radius(surface.shapes[link]->points.points(), point.p_L, point.n_L);
      tip.center_L = point.p_L - tip.radius * point.n_L;
      tip.exact = false;
    }
    tips.push_back(tip);
  }
  return tips;
}

TipTouch touch(const FingerTip& tip, const HandSurface& surface, const GraspTarget& target,
               const Eigen::Isometry3d& X_OL) {
  if (!tip.exact) return touch_by_samples(tip, surface, target, X_OL);
  const robot::MeshDistance::Query at = target.distance->query(X_OL * tip.center_L);
  return {at.distance - tip.radius, at.point, -outward(*target.distance, at)};
}

}  // namespace opponens::grasp
