// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "motion/syn_planner.hpp"

namespace opponens::cli {

/// Where one arm may grasp: an arm solution of one of its grasps.
struct ArmGoal {
  std::size_t grasp = 0;  ///< index into Query::grasps
  std::size_t solution = 0;
};

/// Where all driven arms grasp: a goal of the search.
struct Goal {
  motion::GoalRoot root;            ///< the pre-grasp, with the boxes of the grasps' groups
  std::vector<std::size_t> grasps;  ///< [driven arms] indices into Query::grasps
  Eigen::VectorXd q_grasp;          ///< [d] where the closing segment ends
};

struct Query {
  Eigen::VectorXd start;
  SynergySet synergies;
  std::vector<Stored<Grasp>> grasps;                     ///< the first arm's, then the next one's
  std::vector<std::vector<ArmGoal>> arm_goals;           ///< [driven arms] all that may be goals, the best grasps first
  std::vector<motion::GoalRoot> goals;                   ///< goal = index into this list
  std::vector<std::vector<std::size_t>> grasps_of_goal;  ///< [goals][driven arms] indices into grasps
  std::vector<Eigen::VectorXd> q_grasp;                  ///< of each goal

  void add(Goal goal);
  /// The grasps that a goal reaches, in the order of the arms.
  std::vector<const Stored<Grasp>*> grasps_at(int goal) const;
  /// The start's box: the pre-grasp phase's for every hand.
  SynergyBox start_box() const;
};

/// No goals yet. Throws InputError when the store has no grasps of some arm for this world, or the scene no start.
Query make_query(const storage::Store& store, const NamedWorld& world);

/// parts: one for each driven arm.
Goal goal_of(const Query& query, const robot::RobotModel& robot, const std::vector<ArmGoal>& parts);

}  // namespace opponens::cli
