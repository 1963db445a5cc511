// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/hand_seed.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "grasp/random_vector.hpp"

namespace opponens::grasp {
namespace {

constexpr int kSeedAttempts = 20;      // poses drawn until the palm is clear
constexpr int kSeeds = 8;              // drawn per trial; the best by the objective is optimised
constexpr double kAxisShare = 0.25;    // of the seeds that come along a principal axis of the object
constexpr double kMaxStandoff = 0.08;  // m between palm and object surface
constexpr double kMaxTilt = 0.5;       // rad between approach direction and surface normal

/// A direction at most kMaxTilt from d.
Eigen::Vector3d tilt(const Eigen::Vector3d& d, Rng& rng) {
  const Eigen::Vector3d any = normal_vector(rng);
  const Eigen::Vector3d side = (any - any.dot(d) * d).normalized();
  const double angle = kMaxTilt * std::sqrt(rng.uniform());
  return std::cos(angle) * d + std::sin(angle) * side;
}

bool palm_is_clear(const SeedSpace& space, const Eigen::Isometry3d& X_OH, const std::vector<Eigen::Isometry3d>& X_HL) {
  for (const int link : space.surface.palm_links) {
    const auto i = static_cast<std::size_t>(link);
    for (const Eigen::Vector3d& p_L : space.surface.shapes[i]->sparse) {
      const Eigen::Vector3d p_O = X_OH * X_HL[i] * p_L;
      if (space.target.grid->value(p_O) < -0.005) return false;
      if (space.target.obstacle_distance(p_O, 0.005).value < 0.002) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<HandSeed> draw_seed(const SeedSpace& space, Rng& rng) {
  const SynergyBox& box = space.box;
  for (int attempt = 0; attempt < kSeedAttempts; ++attempt) {
    HandSeed seed;
    seed.y.resize(box.half_width.size());
    for (Eigen::Index i = 0; i < seed.y.size(); ++i) seed.y[i] = box.half_width[i] * rng.uniform(-1.0, 1.0);
    const auto X_HL = space.hand.link_poses(space.hand.clip(analysis::configuration(box, seed.y)));
    const bool by_axis = rng.uniform() < kAxisShare;
    const SurfaceSeed point = by_axis ? sample_axis(space.target, rng) : sample_surface(space.target, rng);
    const Eigen::Vector3d d = tilt(-point.n_O, rng);
    const Eigen::AngleAxisd roll(2.0 * std::numbers::pi * rng.uniform(), d);
    seed.X_OH.linear() =
        roll.toRotationMatrix() * Eigen::Quaterniond::FromTwoVectors(space.surface.approach, d).toRotationMatrix();
    // The middle between palm and fingers' contact points comes over the surface point, or the palm itself.
    Eigen::Vector3d aim = space.surface.palm_center;
    if (rng.uniform() < 0.5) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      const auto& points = space.hand.description().contact_points;
      for (const auto& p : points) mean += X_HL[static_cast<std::size_t>(p.link)] * p.p_L / points.size();
      const double ahead = (mean - aim).dot(space.surface.approach);
      aim = mean - ahead * space.surface.approach;
    }
    const double standoff = kMaxStandoff * rng.uniform();
    seed.X_OH.translation() = point.p_O - standoff * d - seed.X_OH.linear() * aim;
    if (palm_is_clear(space, seed.X_OH, X_HL)) return seed;
  }
  return std::nullopt;
}

std::optional<HandSeed> best_seed(const SeedSpace& space, GraspObjective& objective, Rng& rng) {
  std::optional<HandSeed> best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSeeds; ++i) {
    auto seed = draw_seed(space, rng);
    if (!seed) break;  // twenty attempts failed: the next ones would too
    Eigen::VectorXd x = Eigen::VectorXd::Zero(objective.size());
    x.tail(seed->y.size()) = seed->y;
    const double cost = objective.evaluate(*seed, x, nullptr);
    if (cost >= least) continue;
    least = cost;
    best = std::move(seed);
  }
  return best;
}

}  // namespace opponens::grasp
