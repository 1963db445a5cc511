// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Goals that join later, and steps of joint groups.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "motion/syn_planner.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

const Eigen::Vector4d kBeforeWall(-1, -1, 0.2, 0);
const Eigen::Vector4d kBehindWall(1, -1, -0.3, 0.25);

std::vector<GoalRoot> goals_behind() {
  return {{kBehindWall, line_box(0.25), 7}, {Eigen::Vector4d(1.5, -1.5, 0, 0.6), line_box(0.6), 9}};
}

TEST(SynPlanner, RootsJoinWhenTheyAreTo) {
  ToyWorld toy;
  toy.add_wall(0.5, 0.7);
  std::vector<GoalRoot> goals = goals_behind();
  goals.push_back({Eigen::Vector4d(0, 0, 0, 0), line_box(0), 11, 3});  // in the wall
  goals.push_back({Eigen::Vector4d(3, 0, 0, 0), line_box(0), 12, 4});  // outside
  goals.push_back({kBehindWall, line_box(0), 13, 1'000'000});
  for (std::size_t i = 0; i < 2; ++i) goals[i].joins_at = 20;
  PlannerSettings settings;
  settings.diagnose = true;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const PlanAnswer result = plan_toy(toy, kBeforeWall, goals, settings, seed);
    ASSERT_EQ(result.status, PlanStatus::solved);
    EXPECT_GT(result.iterations, 20) << "no goal before that";
    EXPECT_EQ(result.goals_refused, 2);
    ASSERT_TRUE(result.diagnostics);
    EXPECT_EQ(result.diagnostics->goals[2].fate, GoalFate::in_collision);
    EXPECT_EQ(result.diagnostics->goals[3].fate, GoalFate::outside_limits);
    EXPECT_EQ(result.diagnostics->goals[4].fate, GoalFate::not_joined);
    EXPECT_EQ(plan_toy(toy, kBeforeWall, goals, settings, seed).path.waypoints, result.path.waypoints);
  }
  settings.max_iterations = 19;
  const PlanAnswer early = plan_toy(toy, kBeforeWall, goals, settings, 1);
  EXPECT_EQ(early.status, PlanStatus::iteration_limit) << "goals may still come: not no_goals";
  EXPECT_GT(early.diagnostics->start_vertices, 1) << "the start's tree grows alone";
  settings.max_iterations = 100000;
  const PlanAnswer refused = plan_toy(toy, kBeforeWall, {goals[2], goals[3]}, settings, 1);
  EXPECT_EQ(refused.status, PlanStatus::no_goals);
  EXPECT_EQ(refused.iterations, 4) << "known when the last has joined";
}

TEST(SynPlanner, AGoalThatJoinsLaterLeavesTheSearchBeforeItAsItWas) {
  ToyWorld toy;
  toy.add_wall(0.5, 0.7);
  std::vector<GoalRoot> goals{goals_behind().front()};
  const PlanAnswer alone = plan_toy(toy, kBeforeWall, goals, {}, 5);
  goals.push_back(goals_behind().back());
  goals.back().joins_at = alone.iterations;
  const PlanAnswer with_late = plan_toy(toy, kBeforeWall, goals, {}, 5);
  EXPECT_EQ(with_late.path.waypoints, alone.path.waypoints);
  EXPECT_EQ(with_late.collision_checks, alone.collision_checks);
  goals.back().joins_at = 0;
  EXPECT_NE(plan_toy(toy, kBeforeWall, goals, {}, 5).collision_checks, alone.collision_checks);
}

TEST(SynPlanner, MostTargetsAreWithinATurnAroundStartAndGoals) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  PlanQuery query{{Eigen::Vector4d(3.0, -6.0, -5.0, 0.5), {}, -1}, {}, {"a", "b", "c", "d"}, {}, {}, {}};
  query.goals.push_back({Eigen::Vector4d(3.2, -6.2, 5.0, -0.5), {}, 0});
  query.goals.push_back({Eigen::Vector4d(-6.0, 6.0, 0.0, 0.0), {}, 1, 5});  // joins later
  query.upper = Eigen::Vector4d(2.0 * kTurn, kTurn, kTurn, 1.0);
  query.lower = -query.upper;
  query.weights = Eigen::Vector4d::Ones();
  const JointInterval part = sampled_part(query, kTurn);
  // In the middle; at a limit; no shorter than start and goal need; limits less than a turn apart.
  EXPECT_TRUE(part.lower.isApprox(Eigen::Vector4d(3.1 - 0.5 * kTurn, -kTurn, -5.0, -1.0), 1e-12)) << part.lower;
  EXPECT_TRUE(part.upper.isApprox(Eigen::Vector4d(3.1 + 0.5 * kTurn, 0.0, 5.0, 1.0), 1e-9)) << part.upper;
  EXPECT_EQ(sampled_part(query, std::numeric_limits<double>::infinity()).lower, query.lower);
  EXPECT_EQ(sampled_part(query, std::numeric_limits<double>::infinity()).upper, query.upper);
}

TEST(SynPlanner, NoGroupMovesMoreThanItsEpsilon) {
  ToyWorld toy;
  toy.add_wall(0.5, 0.7);
  const auto widest = [&](const PlanAnswer& result, Eigen::Index first) {
    double most = 0.0;
    const Eigen::MatrixXd& q = result.path.waypoints;
    for (Eigen::Index i = 1; i < q.rows(); ++i) {
      most = std::max(most, (q.row(i) - q.row(i - 1)).segment(first, 2).norm());
    }
    return most;
  };
  for (const Variant which : {Variant::synergy, Variant::rrtconnect}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      PlannerSettings settings;
      settings.variant = which;
      const PlanAnswer plain = plan_toy(toy, kBeforeWall, goals_behind(), settings, seed);
      EXPECT_GT(widest(plain, 0), 0.21) << "or the bound below would bind nothing";
      settings.group_steps = {{0, 2, 0.2}, {2, 2, 0.05}};
      const PlanAnswer bound = plan_toy(toy, kBeforeWall, goals_behind(), settings, seed);
      ASSERT_EQ(bound.status, PlanStatus::solved);
      EXPECT_LE(widest(bound, 0), 0.2 + 1e-12);
      EXPECT_LE(widest(bound, 2), 0.05 + 1e-12);
      settings.group_steps = {{0, 2, 100.0}, {2, 2, 100.0}};
      EXPECT_EQ(plan_toy(toy, kBeforeWall, goals_behind(), settings, seed).path.waypoints, plain.path.waypoints);
    }
  }
  PlannerSettings settings;
  settings.group_steps = {{3, 2, 0.1}};
  EXPECT_THROW(plan_toy(toy, kBeforeWall, goals_behind(), settings, 1), std::invalid_argument);
  settings.group_steps = {{2, 2, 0.0}};
  EXPECT_THROW(plan_toy(toy, kBeforeWall, goals_behind(), settings, 1), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::motion
