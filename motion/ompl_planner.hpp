// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <ompl/base/Planner.h>
#include <Eigen/Core>

#include "core/path.hpp"
#include "motion/syn_planner.hpp"

namespace opponens::motion {

/// Algorithms 2-4 for any OMPL program whose state space is a RealVectorStateSpace or a compound of such: the space's
/// bounds are the joint limits, the space information's motion validator and state validity checker are the world.
/// The goal is a GoalState or GoalStates, all of whose states are rooted from the beginning; the first start state is
/// used. Every solve() is a new search with the same seed: equal problems get equal paths, whatever OMPL's own seed is.
/// collision_checks of result() is exact for OMPL's DiscreteMotionValidator.
class SynPlanner : public ompl::base::Planner {
 public:
  explicit SynPlanner(const ompl::base::SpaceInformationPtr& si, PlannerSettings settings = {}, std::uint64_t seed = 1);

  /// PROJECT of the start's tree; empty: the identity.
  void set_start_projection(Projection projection) { start_projection_ = std::move(projection); }
  /// PROJECT of each goal state's tree, in the order of the goal's states; one alone serves all; none: the identity.
  void set_goal_projections(std::vector<Projection> projections) { goal_projections_ = std::move(projections); }
  /// Weights of the joint metric, [d]; ones when not set.
  void set_weights(const Eigen::VectorXd& weights) { weights_ = weights; }
  void set_seed(std::uint64_t seed) { seed_ = seed; }
  void set_settings(const PlannerSettings& settings);
  /// The last solve()'s answer with its counts.
  const PlanResult& result() const { return result_; }

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
  void clear() override;

  /// Epsilon under the name that OMPL's programs know ("range").
  void setRange(double step) { settings_.step = step; }
  double getRange() const { return settings_.step; }

 private:
  PlannerSettings settings_;
  std::uint64_t seed_;
  Eigen::VectorXd weights_;
  Projection start_projection_;
  std::vector<Projection> goal_projections_;
  PlanResult result_;
};

}  // namespace opponens::motion
