// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "distance.hpp"

#include <algorithm>
#include <limits>

#include "grasp/body_distance.hpp"

namespace simulated_postures {
namespace {

template <typename Distance>
double least_on_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Distance&& distance) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {  // (2/3)^40 of a segment below 0.1 m
    const double first = low + (high - low) / 3.0;
    const double second = high - (high - low) / 3.0;
    if (distance(a + first * (b - a)) < distance(a + second * (b - a))) {
      high = second;
    } else {
      low = first;
    }
  }
  return distance(a + 0.5 * (low + high) * (b - a));
}

double to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double part = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - part * along).norm();
}

}  // namespace

double signed_distance(const opponens::robot::Geometry& body, const Eigen::Isometry3d& X_WB, const Capsule& capsule,
                       const Eigen::Isometry3d& X_WL) {
  const Eigen::Isometry3d X_GL = (X_WB * body.X_BG).inverse() * X_WL;
  const opponens::grasp::BodyDistance distance({{body.shape, Eigen::Isometry3d::Identity()}});
  constexpr double kExact = std::numeric_limits<double>::infinity();
  return least_on_segment(X_GL * capsule.a, X_GL * capsule.b,
                          [&](const Eigen::Vector3d& p) { return distance.query(p, kExact).value; }) -
         capsule.radius;
}

double gap(const Capsule& first, const Eigen::Isometry3d& X_W1, const Capsule& second, const Eigen::Isometry3d& X_W2) {
  const Eigen::Vector3d a = X_W2 * second.a;
  const Eigen::Vector3d b = X_W2 * second.b;
  return least_on_segment(X_W1 * first.a, X_W1 * first.b,
                          [&](const Eigen::Vector3d& p) { return to_segment(p, a, b); }) -
         first.radius - second.radius;
}

}  // namespace simulated_postures
