// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/plan_diagnostics.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "motion/search_counts.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

const Eigen::Vector4d kWestOfWall(-1, -1, 0.2, 0);

std::vector<GoalRoot> goals_east() {
  return {{Eigen::Vector4d(1, -1, -0.3, 0.25), line_box(0.25), 7},
          {Eigen::Vector4d(1.5, -1.5, 0, 0.6), line_box(0.6), 9}};
}

World explained_world(const ToyWorld& toy, std::int64_t& asked) {
  World world = toy.world();
  world.explain = [&toy, &asked](const Eigen::VectorXd& q) {
    ++asked;
    std::vector<std::pair<std::string, std::string>> pairs;
    for (std::size_t i = 0; i < toy.obstacles.size(); ++i) {
      const auto& box = toy.obstacles[i];
      if ((q.array() > box.lower.array()).all() && (q.array() < box.upper.array()).all()) {
        pairs.emplace_back("point", "wall " + std::to_string(i));
      }
    }
    return pairs;
  };
  return world;
}

PlanAnswer explained(const ToyWorld& toy, const Eigen::Vector4d& start, const std::vector<GoalRoot>& goals,
                     std::int64_t& asked, std::int64_t iterations = 2000) {
  PlannerSettings settings;
  settings.max_iterations = iterations;
  return plan(start, line_box(0.0), goals, toy.names, toy.hand, toy.lower, toy.upper, toy.weights,
              explained_world(toy, asked), settings, 1);
}

bool says(const PlanDiagnostics& diagnostics, const std::string& words) {
  for (const auto& sentence : sentences(diagnostics, [](int goal) { return "goal " + std::to_string(goal); })) {
    if (sentence.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(PlanDiagnostics, AWallIsNamedAndTheGapIsItsThickness) {
  ToyWorld toy;
  toy.add_wall(2.5, 2.6);  // no way through
  std::int64_t asked = 0;
  const PlanAnswer result = explained(toy, kWestOfWall, goals_east(), asked);
  ASSERT_EQ(result.status, PlanStatus::iteration_limit);
  ASSERT_TRUE(result.diagnostics);
  const PlanDiagnostics& why = *result.diagnostics;
  EXPECT_GT(why.blocked, 1000);
  EXPECT_EQ(why.explained, asked) << "the world is asked for nothing else";
  EXPECT_LE(why.explained, 64);
  EXPECT_GE(why.explained, 32);
  ASSERT_FALSE(why.pairs.empty());
  EXPECT_EQ(why.pairs.front().pair, NamePair("point", "wall 0"));
  EXPECT_EQ(why.pairs.front().count, why.explained) << "each blocked configuration lies in the wall";
  EXPECT_GT(why.gap, 0.2) << "the wall is 0.2 thick";
  EXPECT_LT(why.gap, 0.4);
  EXPECT_TRUE(why.gap_goal == 7 || why.gap_goal == 9);
  EXPECT_TRUE(says(why, "point with wall 0"));
  EXPECT_TRUE(says(why, "came within"));
  EXPECT_EQ(explained(toy, kWestOfWall, goals_east(), asked).diagnostics->gap, why.gap) << "deterministic";
  const PlanAnswer shorter = explained(toy, kWestOfWall, goals_east(), asked, 5);
  EXPECT_GT(shorter.diagnostics->gap, why.gap) << "less of a search comes less near";
}

TEST(PlanDiagnostics, GoalsAndStartAreExplained) {
  ToyWorld toy;
  toy.add_wall(0.5, 0.7);
  std::int64_t asked = 0;
  const PlanAnswer goals = explained(
      toy, kWestOfWall,
      {{Eigen::Vector4d(0, 0, 0, 0), line_box(0), 4}, {Eigen::Vector4d(2.5, 0, 0, -1.25), line_box(0), 5}}, asked);
  ASSERT_EQ(goals.status, PlanStatus::no_goals);
  EXPECT_EQ(goals.diagnostics->goals[0].pairs, (std::vector<NamePair>{{"point", "wall 0"}}));
  ASSERT_EQ(goals.diagnostics->goals[1].outside.size(), 2U);
  EXPECT_EQ(goals.diagnostics->goals[1].outside[0].joint, "x");
  EXPECT_DOUBLE_EQ(goals.diagnostics->goals[1].outside[0].excess, 0.5);
  EXPECT_DOUBLE_EQ(goals.diagnostics->goals[1].outside[1].excess, -0.25);
  EXPECT_TRUE(says(*goals.diagnostics, "goal 4: in collision: point with wall 0"));
  EXPECT_TRUE(
      says(*goals.diagnostics, "x is above its upper limit by 0.5 rad, h2 is below its lower limit by 0.25 rad"));
  const PlanAnswer start = explained(toy, {0, 0, 0, 0}, goals_east(), asked);
  ASSERT_EQ(start.status, PlanStatus::start_in_collision);
  EXPECT_EQ(start.diagnostics->start_pairs, (std::vector<NamePair>{{"point", "wall 0"}}));
  EXPECT_TRUE(says(*start.diagnostics, "at the start collide: point with wall 0"));
  EXPECT_FALSE(says(*start.diagnostics, "goal 7")) << "no goal was asked about";
  EXPECT_FALSE(plan_toy(toy, kWestOfWall, goals_east(), {}, 1).diagnostics)
      << "not of a success that nobody asked about";
}

TEST(PlanDiagnostics, ARootThatNeverGrewIsTold) {
  ToyWorld toy;
  toy.add_wall(2.5, 2.6);
  // A cell of its own around the second goal, smaller than a step.
  const Eigen::Vector4d goal(1.5, -1.5, 0, 0.6);
  for (int axis = 0; axis < 4; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      ToyWorld::Obstacle wall{goal.array() - 0.05, goal.array() + 0.05};
      wall.lower[axis] = goal[axis] + (side > 0 ? 0.02 : -0.05);
      wall.upper[axis] = goal[axis] + (side > 0 ? 0.05 : -0.02);
      toy.obstacles.push_back(wall);
    }
  }
  std::int64_t asked = 0;
  const PlanAnswer result = explained(toy, kWestOfWall, goals_east(), asked, 1000);
  EXPECT_GT(result.diagnostics->goals[0].vertices, 10);
  EXPECT_EQ(result.diagnostics->goals[1].vertices, 1);
  EXPECT_TRUE(says(*result.diagnostics, "goal 9: rooted, but its tree never grew"));
}

TEST(PlanDiagnostics, TheRecordOfBlockedStepsIsEvenAndBounded) {
  BlockedRecord record;
  for (int i = 0; i < 10000; ++i) {
    record.add(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 2.0 * i), 0.5);
    ASSERT_LE(record.kept().size(), BlockedRecord::kMost);
    ASSERT_GE(record.kept().size() * 2 + 1, std::min<std::size_t>(BlockedRecord::kMost, static_cast<std::size_t>(i)));
  }
  EXPECT_EQ(record.seen(), 10000);
  const double stride = record.kept()[1][0];
  for (std::size_t i = 0; i < record.kept().size(); ++i) {
    EXPECT_DOUBLE_EQ(record.kept()[i][0], stride * static_cast<double>(i));
  }
  EXPECT_GT(record.kept().back()[0], 10000 - 2 * stride);
}

}  // namespace
}  // namespace opponens::motion
