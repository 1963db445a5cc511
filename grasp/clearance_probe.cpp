// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/clearance_probe.hpp"

#include <algorithm>
#include <cstddef>

namespace opponens::grasp {
namespace {

constexpr double kExactWithin = 0.004;     // m, nearer points are measured on the mesh instead of the grid
constexpr double kObstacleMargin = 0.003;  // m, a finger stops this far from support and obstacles
constexpr double kSelfMargin = 0.001;      // m, and this far from the hand's other links
constexpr double kFar = 0.05;              // m, distances beyond it do not matter

}  // namespace

Clearance ClearanceProbe::operator()(const HandPose& pose, const std::vector<int>& links, Watch watch) {
  scene_.hand.link_poses(pose.q, X_HL_);
  near_.clear();
  Clearance least{kFar, -1, Eigen::Vector3d::Zero()};
  for (const int link : links) look_at_object(pose.X_OH, static_cast<std::size_t>(link), least);
  // Most promising first: once a point's rough distance exceeds the best by the grid's error, the rest cannot win.
  std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) { return a.rough < b.rough; });
  // Deep inside, the rough depth is enough: it only tells how far to move before asking again.
  if (!near_.empty() && near_.front().rough < -2.0 * scene_.target.grid->spacing()) {
    return {near_.front().rough, near_.front().link, near_.front().p_O};
  }
  for (const Near& point : near_) {
    if (point.rough > least.value + scene_.target.grid->spacing()) break;
    const double exact = scene_.target.distance->signed_distance(point.p_O);
    if (exact < least.value) least = {exact, point.link, point.p_O};
  }
  for (const int link : links) {
    if (watch != Watch::object) look_at_obstacles(pose.X_OH, static_cast<std::size_t>(link), least);
    if (watch == Watch::everything) look_at_hand(static_cast<std::size_t>(link), least);
  }
  return least;
}

void ClearanceProbe::look_at_object(const Eigen::Isometry3d& X_OH, std::size_t link, Clearance& least) {
  const DistanceGrid& grid = *scene_.target.grid;
  const Eigen::Isometry3d X_OL = X_OH * X_HL_[link];
  const double bound = grid.value(X_OL * scene_.surface.link_center[link]) - scene_.surface.link_radius[link];
  if (bound - grid.spacing() > least.value) return;
  for (const Eigen::Vector3d& p_L : scene_.surface.medium[link]) {
    const Eigen::Vector3d p_O = X_OL * p_L;
    const double rough = grid.value(p_O);
    if (rough < kExactWithin) {
      near_.push_back({rough, static_cast<int>(link), p_O});
    } else if (rough < least.value) {
      least = {rough, static_cast<int>(link), p_O};
    }
  }
}

void ClearanceProbe::look_at_obstacles(const Eigen::Isometry3d& X_OH, std::size_t link, Clearance& least) const {
  const Eigen::Isometry3d X_OL = X_OH * X_HL_[link];
  const double radius = scene_.surface.link_radius[link];
  const Eigen::Vector3d center = X_OL * scene_.surface.link_center[link];
  if (scene_.target.obstacle_distance(center, kFar).value - radius - kObstacleMargin > least.value) return;
  for (const Eigen::Vector3d& p_L : scene_.surface.medium[link]) {
    const double horizon = std::max(least.value, 0.0) + kObstacleMargin;  // farther does not matter
    const double free = scene_.target.obstacle_distance(X_OL * p_L, horizon).value - kObstacleMargin;
    if (free < least.value) least = {free, -1, Eigen::Vector3d::Zero()};
  }
}

void ClearanceProbe::look_at_hand(std::size_t link, Clearance& least) const {
  for (const int stranger : scene_.surface.strangers[link]) {
    const auto other = static_cast<std::size_t>(stranger);
    const Eigen::Isometry3d X_BA = X_HL_[other].inverse() * X_HL_[link];
    const double apart = (X_BA * scene_.surface.link_center[link] - scene_.surface.link_center[other]).norm();
    const double bound = apart - scene_.surface.link_radius[link] - scene_.surface.link_radius[other];
    if (bound - kSelfMargin > least.value) continue;
    for (const Eigen::Vector3d& p_A : scene_.surface.coarse[link]) {
      const Eigen::Vector3d p_B = X_BA * p_A;
      const double reach = std::max(least.value + kSelfMargin, 0.0) + scene_.surface.link_radius[other];
      if ((p_B - scene_.surface.link_center[other]).squaredNorm() > reach * reach) continue;
      const double free = scene_.surface.links[other].query(p_B, kFar).value - kSelfMargin;
      if (free < least.value) least = {free, -1, Eigen::Vector3d::Zero()};
    }
  }
}

}  // namespace opponens::grasp
