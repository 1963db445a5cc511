// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include <ompl/base/Planner.h>
#include <Eigen/Core>

#include "motion/plan_diagnostics.hpp"
#include "motion/syn_planner.hpp"

namespace opponens::motion {

/// Algorithms 2-4 for any OMPL program whose state space is a RealVectorStateSpace or a compound of such: the space's
/// bounds are the joint limits, the space information's motion validator and state validity checker are the world.
/// The goal is a GoalState or GoalStates, all of whose states are rooted from the beginning; the first start state is
/// used. Every solve() is a new search with the same seed: equal problems get equal paths, whatever OMPL's own seed is.
/// collision_checks of result() is exact for OMPL's DiscreteMotionValidator. Parameters: range (rad, epsilon), variant
/// (kVariantNames), full_space_probability, max_iterations, max_checks. Progress properties: iterations, collision
/// checks, states.
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
  const PlanAnswer& result() const { return result_; }

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& ptc) override;
  void clear() override;
  /// Both graphs of the last solve(): start and goal vertices, edges in the direction of the motion.
  void getPlannerData(ompl::base::PlannerData& data) const override;

  /// Epsilon under the name that OMPL's programs know ("range").
  void setRange(double step) { settings_.step = step; }
  double getRange() const { return settings_.step; }

 private:
  /// What a benchmark's thread may read during solve().
  struct Progress {
    std::atomic<std::int64_t> iterations{0};
    std::atomic<std::int64_t> collision_checks{0};
    std::atomic<std::int64_t> vertices{0};
  };

  void declare_parameters();
  void declare_progress();
  PlanQuery query_of(const std::vector<const ompl::base::State*>& goals) const;

  PlannerSettings settings_;
  std::uint64_t seed_;
  Eigen::VectorXd weights_;
  Projection start_projection_;
  std::vector<Projection> goal_projections_;
  PlanAnswer result_;
  std::vector<Graph> graphs_;  ///< of the last solve(): the start's, the goals'; or none
  std::optional<Bridge> bridge_;
  Progress progress_;
};

}  // namespace opponens::motion
