// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/human_likeness.hpp"
#include "cli/commands.hpp"
#include "cli/goal_pairs.hpp"
#include "cli/json.hpp"
#include "cli/query.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "motion/contact_depth.hpp"
#include "motion/continuous_check.hpp"
#include "motion/followed_boxes.hpp"
#include "motion/plan_diagnostics.hpp"
#include "motion/smooth.hpp"
#include "motion/syn_planner.hpp"
#include "motion/time_optimal.hpp"
#include "robot/collision.hpp"

namespace opponens::cli {

struct Run {
  std::uint64_t seed = 0;
  motion::PlanAnswer planned;  ///< as the planner returned it, up to the pre-grasp
  JointPath motion;            ///< final: shortened, its corners rounded, with the closing segment; waypoints = knots
  motion::Trajectory trajectory;  ///< its timing
  int pregrasp_row = -1;
  int stops = 0;             ///< corners up to the pre-grasp that could not be rounded
  Json box_distance;         ///< null for the baseline
  double length = 0.0;       ///< rad, of the shortened path up to the pre-grasp
  double cpu_seconds = 0.0;  ///< of the planner; goes to documents, never into the store
  Json human_likeness = Json::array();
};

/// What every run shares, read only: one may run on each thread.
class Planning {
 public:
  /// Referred to and must outlive this: options and world.
  Planning(const PlanOptions& options, const NamedWorld& world, Query query,
           std::optional<analysis::LikenessReference> free_motion);

  /// With its goals: those with a closing segment that is valid at the chosen resolution.
  const Query& query() const { return query_; }
  std::size_t goals_left_out() const { return goals_left_out_; }
  /// Where two arms are driven.
  const std::optional<PairTally>& pairs() const { return pairs_; }
  const robot::CollisionChecker& checker() const { return free_; }
  /// Whether all pairs keep the clearance; else some only what they have at the start.
  bool keeps_clearance() const { return clearance_->pairs_nearer_at_start() == 0; }
  Run run(std::uint64_t seed) const;
  /// m, how deep a pair that collides at the start is; 0 of others.
  double start_depth(const robot::BodyPair& pair) const;

 private:
  void add_goals();
  motion::World closing_of(const std::vector<std::size_t>& grasps) const;
  std::optional<GoalFault> fault_of(const Goal& goal) const;
  std::string no_goals() const;
  std::optional<motion::FollowedBoxes> followed(const PlanResult& planned) const;
  void finish(Run& run) const;
  std::vector<const SynergyGroup*> groups_of(const std::vector<std::size_t>& grasps) const;

  const PlanOptions& options_;
  const NamedWorld& world_;
  Query query_;
  std::optional<analysis::LikenessReference> free_motion_;
  std::set<std::string> near_start_;  ///< bodies that the start is near to
  robot::CollisionChecker exact_;     ///< the scene as it is
  std::shared_ptr<const motion::ContinuousCheck> clearance_;
  robot::CollisionChecker free_;          ///< bodies grown, for the search
  robot::CollisionChecker closing_free_;  ///< of the closing segment: the objects as they are
  robot::CollisionChecker closing_;       ///< the same, each hand with its object left out
  motion::ContactDepth depth_;
  motion::World space_;
  motion::Clearances clearances_;  ///< empty: paths are not smoothed
  motion::PlannerSettings settings_;
  std::map<robot::BodyPair, double> start_depths_;  ///< m, of the pairs that collide at the start
  std::size_t goals_left_out_ = 0;
  std::optional<PairTally> pairs_;
};

}  // namespace opponens::cli
