// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "motion/edge_check.hpp"
#include "motion/syn_planner.hpp"

namespace opponens::motion {

/// A point in R^d among axis-aligned boxes: two "arm" joints x, y in [-2, 2], then two "hand" joints in [-1, 1].
struct ToyWorld {
  struct Obstacle {
    Eigen::Vector4d lower;
    Eigen::Vector4d upper;
  };
  std::vector<Obstacle> obstacles;
  Eigen::VectorXd lower = Eigen::Vector4d(-2, -2, -1, -1);
  Eigen::VectorXd upper = Eigen::Vector4d(2, 2, 1, 1);
  Eigen::VectorXd weights = Eigen::Vector4d(1, 1, 1, 1);
  PlanningGroup hand{"hand", {"h1", "h2"}, 2, 2};
  std::vector<std::string> names{"x", "y", "h1", "h2"};

  bool valid(const Eigen::VectorXd& q) const {
    if ((q.array() < lower.array() - 1e-9).any() || (q.array() > upper.array() + 1e-9).any()) return false;
    for (const Obstacle& box : obstacles) {
      if ((q.array() > box.lower.array()).all() && (q.array() < box.upper.array()).all()) return false;
    }
    return true;
  }
  World world(double resolution = 0.02) const {
    return make_world([this](const Eigen::VectorXd& q) { return valid(q); }, weights, resolution);
  }
  /// A wall at x in (-0.1, 0.1), solid but for a gap in y and, when `hand_gap`, in h2 > 0.5 only.
  void add_wall(double gap_from, double gap_to, bool hand_gap = false) {
    obstacles.push_back({{-0.1, -3, -2, -2}, {0.1, gap_from, 2, 2}});
    obstacles.push_back({{-0.1, gap_to, -2, -2}, {0.1, 3, 2, 2}});
    if (hand_gap) obstacles.push_back({{-0.1, -3, -2, -2}, {0.1, 3, 2, 0.5}});
  }
};

/// The line { (y, h2) : |y| <= 0.8 } in the hand's plane, k = 1.
inline SynergyBox line_box(double h2) {
  SynergyBox box;
  box.center = Eigen::Vector2d(0.0, h2);
  box.axes = Eigen::Vector2d(1.0, 0.0);
  box.half_width = Eigen::VectorXd::Constant(1, 0.8);
  box.scale = Eigen::Vector2d::Ones();
  return box;
}

inline PlanAnswer plan_toy(const ToyWorld& toy, const Eigen::Vector4d& start, const std::vector<GoalRoot>& goals,
                           const PlannerSettings& settings, std::uint64_t seed) {
  return plan(start, line_box(0.0), goals, toy.names, toy.hand, toy.lower, toy.upper, toy.weights, toy.world(),
              settings, seed);
}

}  // namespace opponens::motion
