// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "core/synergies.hpp"
#include "motion/world.hpp"

namespace opponens::motion {

/// A goal configuration with the synergy box of its grasp's group: the root of one tree of the goal graph.
struct GoalRoot {
  Eigen::VectorXd q;  ///< [d] rad
  SynergyBox box;     ///< hand part of the group's synergies
  int goal = 0;       ///< index reported when this root is reached
};

enum class Variant {
  synergy,     ///< Algorithms 2-4 (the paper's case b)
  rrtconnect,  ///< the multi-goal RRT-Connect baseline (case a): no PROJECT, no SYNCONNECT, no fallback
};

struct PlannerSettings {
  Variant variant = Variant::synergy;
  double step = 0.4;                     ///< rad, epsilon of Algorithm 3 in the weighted metric
  double resolution = 0.02;              ///< rad, spacing of checked configurations in the weighted metric
  double full_space_probability = 0.05;  ///< share of targets that are not projected: keeps probabilistic completeness
  double minimum_step = 1e-9;            ///< rad, SYNEXTEND returns nothing below it
  std::int64_t max_iterations = 100000;
  std::int64_t max_checks = 0;           ///< 0: unlimited
  double time_limit = 0.0;               ///< s of wall clock; 0: none (searches stop on counts)
  std::function<bool()> interrupted;     ///< polled once per iteration; empty: never
};
void validate(const PlannerSettings& settings);

/// One query. group_hand gives the hand's index range in q. Start tree: pre_grasp box; every goal rooted from the
/// beginning. Same seed, same path. lower, upper, weights: [d].
PlanResult plan(const Eigen::VectorXd& start, const SynergyBox& pre_grasp, const std::vector<GoalRoot>& goals,
                const std::vector<std::string>& joint_names, const PlanningGroup& hand, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const Eigen::VectorXd& weights, const World& world,
                const PlannerSettings& settings, std::uint64_t seed);

}  // namespace opponens::motion
