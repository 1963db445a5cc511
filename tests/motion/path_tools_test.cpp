// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "motion/closing_segment.hpp"
#include "motion/edge_check.hpp"
#include "motion/joint_metric.hpp"
#include "motion/shortcut.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

TEST(JointMetric, HandComputed) {
  const Eigen::Vector2d weights(4, 1);
  Eigen::MatrixXd waypoints(3, 2);
  waypoints << 0, 0, 3, -8, 3, -7;
  EXPECT_DOUBLE_EQ(distance(weights, Eigen::Vector2d(0, 0), Eigen::Vector2d(3, -8)), 10.0);
  EXPECT_DOUBLE_EQ(path_length(weights, waypoints), 11.0);
  EXPECT_DOUBLE_EQ(path_length_l1(weights, waypoints), 12 + 8 + 1);
  EXPECT_EQ(path_length(weights, waypoints.topRows(1)), 0.0);
}

TEST(EdgeCheck, VisitsEndThenBisects) {
  std::vector<double> seen;
  std::int64_t checks = 0;
  const Validity valid = [&](const Eigen::VectorXd& q) {
    seen.push_back(q[0]);
    return true;
  };
  const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  EXPECT_FALSE(first_invalid(at(0), at(8), valid, at(1), 1.0, checks));
  EXPECT_EQ(seen, (std::vector<double>{8, 4, 2, 6, 1, 5, 3, 7}));
  EXPECT_EQ(checks, 8);
  seen.clear();
  checks = 0;
  EXPECT_FALSE(first_invalid(at(0), at(5), valid, at(1), 1.0, checks));  // not a power of two: all, once each
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(checks, 5);
}

TEST(EdgeCheck, SpacingIsMeasuredWithTheWeights) {
  std::int64_t checks = 0;
  const Validity valid = [](const Eigen::VectorXd&) { return true; };
  first_invalid(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), valid, Eigen::Vector2d(16, 9), 0.5, checks);
  EXPECT_EQ(checks, 10);  // length 5
  checks = 0;
  EXPECT_FALSE(first_invalid(Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 0), valid, Eigen::Vector2d(1, 1), 0.5, checks));
  EXPECT_EQ(checks, 1);
}

TEST(EdgeCheck, GroupsMayHaveASpacingOfTheirOwn) {
  const Validity valid = [](const Eigen::VectorXd&) { return true; };
  const Eigen::VectorXd weights = Eigen::Vector4d(1, 1, 4, 4);
  const auto count = [&](const Eigen::Vector4d& q, const Spacing& spacing) {
    std::int64_t checks = 0;
    EXPECT_FALSE(first_invalid(Eigen::Vector4d(0, 0, 0, 0), q, valid, weights, spacing, checks));
    return checks;
  };
  const Spacing groups(10.0, {{0, 2, 0.5}, {2, 2, 0.25}});
  EXPECT_EQ(count({3, 4, 0, 0}, groups), 10) << "5 rad of the first at 0.5";
  EXPECT_EQ(count({0, 0, 3, 4}, groups), 40) << "10 rad of the second, weighted, at 0.25";
  EXPECT_EQ(count({3, 4, 0.3, 0.4}, groups), 10) << "the largest of all decides";
  EXPECT_EQ(count({3, 4, 3, 4}, Spacing(0.1, {{0, 2, 0.5}})), 112) << "that of all joints too: sqrt(125) / 0.1";
  EXPECT_EQ(count({3, 4, 3, 4}, 0.1), 112);
  const World world = make_world(valid, weights, groups);
  std::int64_t checks = 0;
  world.confirm(Eigen::Vector4d(0, 0, 0, 0), Eigen::Vector4d(0, 0, 3, 4), checks);
  EXPECT_EQ(checks, 400) << "a tenth of each to confirm";
  EXPECT_THROW(make_world(valid, weights, Spacing(1.0, {{0, 2, 0.0}})), std::invalid_argument);
}

TEST(EdgeCheck, FractionIsThatOfTheInvalidConfiguration) {
  std::int64_t checks = 0;
  const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  const Validity valid = [](const Eigen::VectorXd& q) { return q[0] < 0.6 || q[0] > 0.7; };
  const auto fraction = first_invalid(at(0), at(1), valid, at(1), 0.0625, checks);
  ASSERT_TRUE(fraction);
  EXPECT_DOUBLE_EQ(*fraction, 0.625);
  EXPECT_DOUBLE_EQ(*first_invalid(at(0), at(0.65), valid, at(1), 0.1, checks), 1.0);
}

JointPath zigzag() {
  Eigen::MatrixXd waypoints(6, 4);
  waypoints << -1, -1, 0, 0, -1, 1.5, 0.5, 0, 0, 1.5, 0.5, 0.5, 0, 1.8, 0, 0.5, 1, 1.5, 0, 0, 1, -1, -0.3, 0.2;
  return {{"x", "y", "h1", "h2"}, waypoints};
}

/// Eight at a time the answer is the same; only the count says that the rest of an eight was asked too.
TEST(EdgeCheck, ByRowsIsTheSame) {
  const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  for (const double wall : {0.03, 0.2, 0.51, 0.75, 0.99, 2.0}) {
    const Validity valid = [wall](const Eigen::VectorXd& q) { return q[0] < wall || q[0] > wall + 0.05; };
    const FirstInvalidRow first_row = [&valid](const robot::ConfigurationBatch& batch) -> std::optional<int> {
      EXPECT_LE(batch.rows(), 8);
      for (int row = 0; row < batch.rows(); ++row) {
        if (!valid(batch.row(row).transpose())) return row;
      }
      return std::nullopt;
    };
    std::int64_t one = 0;
    std::int64_t eight = 0;
    EXPECT_EQ(first_invalid(at(0), at(1), valid, at(1), 0.03, one),
              first_invalid_by_rows(at(0), at(1), first_row, at(1), 0.03, eight));
    EXPECT_GE(eight, one);
    EXPECT_LT(eight, one + 8);
    const World world = make_world_by_rows(first_row, at(1), 0.03);
    EXPECT_EQ(static_cast<bool>(world.first_invalid(at(0), at(1), eight)), wall < 1.0);
    EXPECT_EQ(static_cast<bool>(world.confirm(at(0), at(1), eight)), wall < 1.0);
    EXPECT_EQ(world.free(Eigen::Vector2d(0.0, wall + 0.01), eight), (std::vector<bool>{true, false}));
  }
  EXPECT_THROW(make_world_by_rows({}, at(1), 0.03), std::invalid_argument);
}

TEST(Shortcut, ShorterValidAndDeterministic) {
  ToyWorld toy;
  toy.add_wall(0.5, 2.5);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Shortcut result = shortcut(zigzag(), toy.weights, toy.world(), {}, seed);
    EXPECT_LE(result.length, result.length_before);
    EXPECT_GT(result.accepted, 0);
    EXPECT_LT(result.length, 0.9 * result.length_before);
    EXPECT_DOUBLE_EQ(result.length, path_length(toy.weights, result.path.waypoints));
    EXPECT_EQ(result.path.waypoints.row(0), zigzag().waypoints.row(0));
    EXPECT_EQ(result.path.waypoints.bottomRows(1), zigzag().waypoints.bottomRows(1));
    std::int64_t checks = 0;
    const World world = toy.world();
    for (Eigen::Index i = 1; i < result.path.waypoints.rows(); ++i) {
      const Eigen::VectorXd from = result.path.waypoints.row(i - 1).transpose();
      ASSERT_FALSE(world.confirm(from, result.path.waypoints.row(i).transpose(), checks)) << "seed " << seed;
    }
    const Shortcut again = shortcut(zigzag(), toy.weights, toy.world(), {}, seed);
    EXPECT_EQ(again.path.waypoints, result.path.waypoints);
    EXPECT_EQ(again.collision_checks, result.collision_checks);
  }
}

TEST(Shortcut, LengthFallsWithEveryIterationAndAStraightPathStays) {
  ToyWorld toy;
  toy.add_wall(0.5, 2.5);
  double last = INFINITY;
  for (const int iterations : {0, 1, 5, 20, 100}) {
    const Shortcut result = shortcut(zigzag(), toy.weights, toy.world(), {iterations}, 4);
    EXPECT_LE(result.length, last);
    last = result.length;
  }
  JointPath straight{zigzag().joint_names, Eigen::MatrixXd(3, 4)};
  straight.waypoints << -1, 1.5, 0, 0, 0, 1.5, 0, 0, 1, 1.5, 0, 0;
  EXPECT_EQ(shortcut(straight, toy.weights, toy.world(), {}, 1).path.waypoints, straight.waypoints);
  EXPECT_THROW(shortcut(straight, toy.weights, toy.world(), {-1}, 1), std::invalid_argument);
}

TEST(ClosingSegment, TogetherWhereItCanElseArmFirst) {
  ToyWorld toy;
  const Eigen::Vector4d from(-1, 0, 0, 0);
  const Eigen::Vector4d to(0, 0, 0, 0.9);
  EXPECT_EQ(closing_segment(from, to, toy.hand, toy.world()).waypoints.rows(), 2);
  toy.obstacles.push_back({{-0.6, -1, -1, 0.3}, {-0.4, 1, 1, 0.6}});  // in the middle of the straight way
  const ClosingSegment around = closing_segment(from, to, toy.hand, toy.world());
  ASSERT_EQ(around.waypoints.rows(), 3);
  EXPECT_EQ(Eigen::VectorXd(around.waypoints.row(1).transpose()), Eigen::VectorXd(Eigen::Vector4d(0, 0, 0, 0)));
  toy.obstacles.push_back({{-0.6, -1, -1, -0.1}, {-0.4, 1, 1, 0.1}});
  const ClosingSegment none = closing_segment(from, to, toy.hand, toy.world());
  EXPECT_EQ(none.waypoints.size(), 0);
  ASSERT_TRUE(none.invalid);
  EXPECT_FALSE(toy.valid(*none.invalid));
}

TEST(ClosingSegment, IsAppendedToThePath) {
  const ToyWorld toy;
  JointPath path = zigzag();
  const Eigen::Vector4d grasp(1.2, -1, 0, 0.4);
  const auto longer = append_closing_segment(path, grasp, toy.hand, toy.world());
  ASSERT_TRUE(longer);
  EXPECT_EQ(longer->waypoints.topRows(6), path.waypoints);
  EXPECT_EQ(Eigen::VectorXd(longer->waypoints.bottomRows(1).transpose()), Eigen::VectorXd(grasp));
  ToyWorld blocked;
  blocked.obstacles.push_back({{1.1, -2, -1, -1}, {1.15, 2, 1, 1}});
  EXPECT_FALSE(append_closing_segment(path, grasp, toy.hand, blocked.world()));
}

}  // namespace
}  // namespace opponens::motion
