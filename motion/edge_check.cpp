// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/edge_check.hpp"

#include <cmath>

#include "core/require.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {

std::optional<double> first_invalid(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, const Validity& valid,
                                    const Eigen::VectorXd& weights, double resolution, std::int64_t& checks) {
  ++checks;
  if (!valid(q_to)) return 1.0;
  const double length = distance(weights, q_from, q_to);
  require(std::isfinite(length), "first_invalid: configurations must be finite");
  const auto segments = static_cast<std::uint64_t>(std::ceil(length / resolution));
  const Eigen::VectorXd difference = q_to - q_from;
  // Index i = k with its bits reversed, for k = 1, 2, ...: coarse to fine.
  int bits = 0;
  while ((std::uint64_t{1} << bits) < segments) ++bits;
  for (std::uint64_t k = 1; k < (std::uint64_t{1} << bits); ++k) {
    std::uint64_t i = 0;
    for (int bit = 0; bit < bits; ++bit) i |= ((k >> bit) & 1U) << (bits - 1 - bit);
    if (i >= segments) continue;
    const double fraction = static_cast<double>(i) / static_cast<double>(segments);
    ++checks;
    if (!valid(q_from + fraction * difference)) return fraction;
  }
  return std::nullopt;
}

World make_world(const Validity& valid, const Eigen::VectorXd& weights, double resolution, double confirm_resolution) {
  require(static_cast<bool>(valid), "make_world: no validity given");
  require(
      std::isfinite(resolution) && resolution > 0.0 && std::isfinite(confirm_resolution) && confirm_resolution >= 0.0,
      "make_world: resolution must be positive, confirm_resolution >= 0, both finite");
  const auto at = [valid, weights](double spacing) -> MotionCheck {
    return [valid, weights, spacing](const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, std::int64_t& checks) {
      return first_invalid(q_from, q_to, valid, weights, spacing, checks);
    };
  };
  World world;
  world.first_invalid = at(resolution);
  world.free = [valid](const Eigen::MatrixXd& batch, std::int64_t& checks) {
    std::vector<bool> free;
    for (const auto& row : batch.rowwise()) free.push_back(valid(row.transpose()));
    checks += batch.rows();
    return free;
  };
  if (confirm_resolution > 0.0) world.confirm = at(confirm_resolution);
  return world;
}

World make_world(const Validity& valid, const Eigen::VectorXd& weights, double resolution) {
  return make_world(valid, weights, resolution, resolution / 10.0);
}

World make_world(const robot::CollisionChecker& checker, const robot::RobotModel& robot, double resolution) {
  return make_world([&checker, &robot](const Eigen::VectorXd& q) { return robot.within_limits(q) && checker.free(q); },
                    robot.weights(), resolution);
}

}  // namespace opponens::motion
