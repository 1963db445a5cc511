// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "motion/edge_check.hpp"
#include "robot/collision.hpp"
#include "verify/path_proof.hpp"

namespace opponens::verify {

struct Motion {
  Eigen::VectorXd from;
  Eigen::VectorXd to;
};

struct Proven {
  bool passed;
  double worst;
  double proven;
};

/// One segment by itself.
inline Proven prove(const robot::RobotModel& robot, const robot::MotionBound& bound, Bodies& bodies,
                    const Motion& motion, const ProofSettings& settings = {}) {
  PathProof proof(robot, bound, bodies, {}, settings);
  proof.visit(motion.from, 0, false, true);
  proof.visit(motion.to, 1, false, false);
  proof.prove(motion.from, motion.to, 1, false);
  Proven result{true, std::numeric_limits<double>::infinity(), proof.proven_clearance()};
  for (const auto& [pair, found] : proof.found()) {
    result.worst = std::min(result.worst, found.distance);
    if (found.distance < settings.clearance || !found.proven) result.passed = false;
  }
  return result;
}

/// Fraction of a collision on the segment among samples at most `spacing` apart, in bisection order.
inline std::optional<double> first_collision(const robot::CollisionChecker& checker, const robot::RobotModel& robot,
                                             const Motion& motion, double spacing) {
  std::int64_t checks = 0;
  return motion::first_invalid(
      motion.from, motion.to, [&](const Eigen::VectorXd& q) { return checker.free(q); }, robot.weights(), spacing,
      checks);
}

}  // namespace opponens::verify
