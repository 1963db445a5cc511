// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "motion/world.hpp"

namespace opponens::table2 {

enum class OmplPlanner { rrtconnect, lbkpiece1, bitrrt };

struct OmplQuery {
  Eigen::VectorXd start;               ///< [d] rad, valid
  std::vector<Eigen::VectorXd> goals;  ///< [d] rad, valid
  std::vector<std::string> joint_names;
  Eigen::VectorXd lower;    ///< [d] rad
  Eigen::VectorXd upper;    ///< [d] rad
  Eigen::VectorXd weights;  ///< [d] of the joint metric, positive
};

struct OmplOutcome {
  /// collision_checks, path, goal, lengths and status as our planner's; extends: motions asked about, extends_grown:
  /// those that were valid; iterations: uniform samples drawn (both mean nothing for a lazy planner).
  PlanResult planned;
  double cpu_seconds = 0.0;  ///< of solve() and of confirming, this thread
};

/// A planner of OMPL on our world: its state validity checker is World::free, its motion validator
/// World::first_invalid, its space the joint limits scaled by sqrt(weights), so that its metric and range are ours; all
/// goals are given as GoalStates. It stops at max_checks configurations, or at as many
/// draws of its sampler, since a lazy planner may check next to nothing. An answer that World::confirm refuses is
/// dropped and the search begins again within the same limit. Deterministic whatever other threads do: all of OMPL's
/// generators are made while a lock is held and OMPL's seed is set from `seed`, and samples come from our own stream.
/// Nobody else may use OMPL's generators meanwhile.
OmplOutcome plan_with_ompl(OmplPlanner planner, const OmplQuery& query, const motion::World& world, double range,
                           std::int64_t max_checks, std::uint64_t seed);

}  // namespace opponens::table2
