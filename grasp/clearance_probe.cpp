// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/clearance_probe.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>

namespace opponens::grasp {
namespace {

constexpr double kExactWithin = 0.002;   // m, nearer points are measured on the mesh instead of the grid
constexpr std::size_t kMeasured = 5;     // of them
constexpr double kBand = 0.0005;         // m, of rough distances among which the nearest point is looked for
constexpr std::size_t kEnoughNear = 40;  // such points: a flat palm on a flat side has a thousand
constexpr double kFarShare = 0.8;    // of a distance beyond kExactWithin: a nearer point within it is not looked for
constexpr double kFarOthers = 0.01;  // m, what is beside the way is not looked for beyond it
constexpr double kObstacleMargin = 0.003;  // m, a finger stops this far from support and obstacles
constexpr double kSelfMargin = 0.001;      // m, and this far from the hand's other links
constexpr double kFarthest = 0.05;         // m, distances beyond it do not matter
constexpr double kExcused = 0.0003;        // m, more than kTouch, by which the excused may come nearer still

}  // namespace

ClearanceProbe::ClearanceProbe(const ClosingScene& scene)
    : scene_(scene),
      object_seen_(scene.surface.shapes.size()),
      obstacles_seen_(scene.surface.shapes.size()),
      hand_seen_(scene.surface.shapes.size() * scene.surface.shapes.size()),
      obstacle_margin_(kObstacleMargin),
      self_margin_(kSelfMargin) {}

void ClearanceProbe::place(const HandPose& pose) {
  scene_.hand.link_poses(pose.q, X_HL_);
  center_H_.resize(X_HL_.size());
  for (std::size_t i = 0; i < X_HL_.size(); ++i) center_H_[i] = X_HL_[i] * scene_.surface.link_center[i];
}

double ClearanceProbe::hand_clearance(const HandPose& pose, const std::vector<int>& links) {
  place(pose);
  self_margin_ = kSelfMargin;
  double least = kFarthest;
  for (const int link : links) least = from_hand(static_cast<std::size_t>(link), least);
  return least;
}

void ClearanceProbe::excuse(const HandPose& pose, const std::vector<int>& links) {
  place(pose);
  obstacle_margin_ = kObstacleMargin;
  self_margin_ = kSelfMargin;
  double obstacles = kExcused;
  double hand = kExcused;
  for (const int link : links) {
    obstacles = from_obstacles(pose.X_OH, static_cast<std::size_t>(link), obstacles);
    hand = from_hand(static_cast<std::size_t>(link), hand);
  }
  obstacle_margin_ += obstacles - kExcused;
  self_margin_ += hand - kExcused;
}

Clearance ClearanceProbe::operator()(const HandPose& pose, const std::vector<int>& links, Watch watch) {
  place(pose);
  near_.clear();
  Clearance least{kFarthest, kFarthest};
  begin_at_last(pose.X_OH, links, least);
  for (const int link : links) look_at_object(pose.X_OH, static_cast<std::size_t>(link), least);
  // Deep inside, the rough depth is enough: it only tells how far to move before asking again.
  const bool deep = least.object < -2.0 * scene_.target.grid->spacing();
  if (!near_.empty() && !deep) measure(least);
  last_link_ = least.link;
  if (least.link >= 0) last_p_L_ = (pose.X_OH * X_HL_[static_cast<std::size_t>(least.link)]).inverse() * least.p_O;
  if (watch == Watch::object || least.object < 0.0) return least;
  least.others = std::clamp(least.object, kEnoughRoom, kFarOthers);
  for (const int link : links) {
    least.others = from_obstacles(pose.X_OH, static_cast<std::size_t>(link), least.others);
    if (watch == Watch::everything) least.others = from_hand(static_cast<std::size_t>(link), least.others);
  }
  return least;
}

/// The point that was nearest when last asked is nearly so again: with it, most others need not be looked at.
void ClearanceProbe::begin_at_last(const Eigen::Isometry3d& X_OH, const std::vector<int>& links,
                                   Clearance& least) const {
  if (std::find(links.begin(), links.end(), last_link_) == links.end()) return;
  const Eigen::Vector3d p_O = X_OH * X_HL_[static_cast<std::size_t>(last_link_)] * last_p_L_;
  const double rough = scene_.target.grid->value(p_O);
  if (rough >= least.object) return;
  least.object = rough;
  least.link = last_link_;
  least.p_O = p_O;
}

double ClearanceProbe::still(const Seen& seen, const Eigen::Isometry3d& X, std::size_t link) const {
  const Eigen::Vector3d& center = scene_.surface.link_center[link];
  // The norm of a difference of rotations is 1 / sqrt(2) of its Frobenius norm.
  return seen.at_least - (X * center - seen.X * center).norm() -
         std::numbers::sqrt2 / 2.0 * scene_.surface.link_radius[link] * (X.linear() - seen.X.linear()).norm();
}

void ClearanceProbe::look_at_object(const Eigen::Isometry3d& X_OH, std::size_t link, Clearance& least) {
  const DistanceGrid& grid = *scene_.target.grid;
  // Near the surface, points little farther than the rough minimum may be the nearest in truth; far from it a fifth of
  // the distance does not matter.
  const auto bound = [&] {
    if (least.object >= kExactWithin) return kFarShare * least.object;
    return near_.size() < kEnoughNear ? std::min(least.object + kBand, kExactWithin) : least.object;
  };
  const Eigen::Isometry3d X_OL = X_OH * X_HL_[link];
  Seen& seen = object_seen_[link];
  if (still(seen, X_OL, link) >= bound()) return;
  double visited = std::numeric_limits<double>::infinity();
  const auto visit = [&](const Eigen::Vector3d&, const Eigen::Vector3d& p_O) {
    const double rough = grid.value(p_O);
    visited = std::min(visited, rough);
    if (rough < kExactWithin && rough < bound()) near_.push_back({rough, static_cast<int>(link), p_O});
    if (rough < least.object) {
      least.object = rough;
      least.link = static_cast<int>(link);
      least.p_O = p_O;
    }
    return bound();
  };
  const auto descent = scene_.surface.shapes[link]->points.descend(
      [&grid](const Eigen::Vector3d& p_O) { return grid.bound(p_O); }, X_OL, bound(), visit);
  seen = {X_OL, std::min(visited, descent.rest)};
}

/// Replaces the rough least distance by the exact one of the points that are likeliest to have it.
void ClearanceProbe::measure(Clearance& least) {
  const std::size_t count = std::min(kMeasured, near_.size());
  std::partial_sort(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(count), near_.end(),
                    [](const Near& a, const Near& b) { return a.rough < b.rough; });
  least.object = kFarthest;
  for (std::size_t i = 0; i < count; ++i) {
    const Near& point = near_[i];
    if (point.rough > least.object + scene_.target.grid->spacing()) break;  // once this far off, the rest cannot win
    const double exact = scene_.target.nearest(point.p_O).distance;
    if (exact >= least.object) continue;
    least.object = exact;
    least.link = point.link;
    least.p_O = point.p_O;
  }
}

double ClearanceProbe::from_obstacles(const Eigen::Isometry3d& X_OH, std::size_t link, double least) {
  if (scene_.target.obstacles.empty()) return least;
  const double horizon = scene_.surface.link_radius[link] + obstacle_margin_ + std::max(least, 0.0);
  const auto distance = [this, horizon](const Eigen::Vector3d& p_O) {
    return scene_.target.obstacle_distance(p_O, horizon).value;
  };
  return nearest(distance, link, X_OH * X_HL_[link], obstacle_margin_, least, obstacles_seen_[link]);
}

double ClearanceProbe::from_hand(std::size_t link, double least) {
  const HandSurface& surface = scene_.surface;
  for (const int stranger : surface.strangers[link]) {
    const auto other = static_cast<std::size_t>(stranger);
    const double reach = surface.link_radius[link] + surface.link_radius[other] + least + self_margin_;
    if ((center_H_[link] - center_H_[other]).squaredNorm() > reach * reach) continue;
    const auto distance = [&](const Eigen::Vector3d& p_B) { return surface.shapes[other]->rough(p_B); };
    least = nearest(distance, link, X_HL_[other].inverse() * X_HL_[link], self_margin_, least,
                    hand_seen_[link * surface.shapes.size() + other]);
  }
  return least;
}

template <typename Distance>
double ClearanceProbe::nearest(const Distance& distance, std::size_t link, const Eigen::Isometry3d& X, double margin,
                               double least, Seen& seen) const {
  const auto bound = [&] { return margin + (least < kExactWithin ? least : kFarShare * least); };
  if (still(seen, X, link) >= bound()) return least;
  double visited = std::numeric_limits<double>::infinity();
  const auto visit = [&](const Eigen::Vector3d&, const Eigen::Vector3d& p) {
    const double here = distance(p);
    visited = std::min(visited, here);
    least = std::min(least, here - margin);
    return bound();
  };
  const auto descent = scene_.surface.shapes[link]->points.descend(distance, X, bound(), visit);
  seen = {X, std::min(visited, descent.rest)};
  return least;
}

}  // namespace opponens::grasp
