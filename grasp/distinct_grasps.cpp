// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/distinct_grasps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/require.hpp"

namespace opponens::grasp {

void validate(const GraspDistances& distances) {
  const auto check = [](const char* field, double value) {
    require(value >= 0.0 && std::isfinite(value), [&] {
      return "GraspDistances: " + std::string(field) + " = " + std::to_string(value) +
             " must be finite and not negative";
    });
  };
  check("position", distances.position);
  check("angle", distances.angle);
  check("joints", distances.joints);
}

bool same_grasp(const Grasp& a, const Grasp& b, const GraspDistances& distances) {
  require(a.q_grasp.size() == b.q_grasp.size(), "same_grasp: the grasps are of different hands");
  if ((a.X_OH.translation() - b.X_OH.translation()).norm() >= distances.position) return false;
  const Eigen::AngleAxisd turn(a.X_OH.linear().transpose() * b.X_OH.linear());
  if (std::abs(turn.angle()) >= distances.angle) return false;
  return a.q_grasp.size() == 0 || (a.q_grasp - b.q_grasp).cwiseAbs().maxCoeff() < distances.joints;
}

std::optional<double> worth_by_epsilon(const Grasp& grasp) { return grasp.quality.epsilon; }

std::vector<std::size_t> distinct_grasps(const std::vector<Grasp>& grasps, int count, const GraspDistances& distances,
                                         const GraspWorth& worth) {
  validate(distances);
  require(count >= 0, "distinct_grasps: count must not be negative");
  std::vector<std::size_t> order(grasps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> value;
  for (const Grasp& grasp : grasps) value.push_back(worth(grasp).value_or(-std::numeric_limits<double>::infinity()));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value[a] > value[b]; });
  std::vector<std::size_t> taken;
  for (const std::size_t i : order) {
    if (taken.size() == static_cast<std::size_t>(count)) break;
    const bool repeats = std::any_of(taken.begin(), taken.end(), [&](std::size_t better) {
      return same_grasp(grasps[better], grasps[i], distances);
    });
    if (!repeats) taken.push_back(i);
  }
  return taken;
}

std::vector<Grasp> best_distinct(std::vector<Grasp> grasps, int count, const GraspDistances& distances,
                                 const GraspWorth& worth) {
  std::vector<Grasp> best;
  for (const std::size_t i : distinct_grasps(grasps, count, distances, worth)) best.push_back(std::move(grasps[i]));
  return best;
}

}  // namespace opponens::grasp
