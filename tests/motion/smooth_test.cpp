// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/smooth.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/rng.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

JointPath around_the_wall() {
  Eigen::MatrixXd waypoints(5, 4);
  waypoints << -1, -1, 0, 0, -1, 1.2, 0.5, 0, 0, 1.0, 0.5, 0.5, 0.6, 1.3, 0, 0.5, 1, -1, -0.3, 0.2;
  return {{"x", "y", "h1", "h2"}, waypoints};
}

TEST(Smooth, SmootherValidAndDeterministic) {
  ToyWorld toy;
  toy.add_wall(0.5, 1.5);
  const World world = toy.world();
  const auto run = [&] { return smooth(around_the_wall(), toy.weights, toy.lower, toy.upper, world, nullptr, {}, {}); };
  const Smoothed result = run();
  EXPECT_LT(result.after.bending, 0.7 * result.before.bending);
  EXPECT_GT(result.moved, result.points / 2);
  EXPECT_EQ(result.path.waypoints.row(0), around_the_wall().waypoints.row(0));
  EXPECT_EQ(result.path.waypoints.bottomRows(1), around_the_wall().waypoints.bottomRows(1));
  std::int64_t checks = 0;
  for (Eigen::Index i = 0; i + 1 < result.path.waypoints.rows(); ++i) {
    ASSERT_TRUE(valid_motion(world, result.path.waypoints.row(i).transpose(),
                             result.path.waypoints.row(i + 1).transpose(), checks));
  }
  EXPECT_EQ(run().path.waypoints, result.path.waypoints);
  // The companion: what the solver wants, not knowing the wall, is not valid.
  const ToyWorld empty;
  const Smoothed blind = smooth(around_the_wall(), toy.weights, toy.lower, toy.upper, empty.world(), nullptr, {}, {});
  bool collides = false;
  for (Eigen::Index i = 0; i + 1 < blind.path.waypoints.rows(); ++i) {
    collides = collides || !valid_motion(world, blind.path.waypoints.row(i).transpose(),
                                         blind.path.waypoints.row(i + 1).transpose(), checks);
  }
  EXPECT_TRUE(collides);
}

/// The distance of (x, y) from a disc, and its slope.
Eigen::VectorXd from_disc(const Eigen::VectorXd& q, Eigen::MatrixXd* derivative) {
  const Eigen::Vector2d away = q.head(2) - Eigen::Vector2d(0.0, -1.05);
  if (derivative != nullptr) {
    *derivative = Eigen::MatrixXd::Zero(1, q.size());
    derivative->leftCols(2) = away.normalized().transpose();
  }
  return Eigen::VectorXd::Constant(1, away.norm() - 0.2);
}

TEST(Smooth, KeepsClearWhereDistancesAreGiven) {
  const ToyWorld toy;
  SmoothSettings settings;
  settings.clearance = 0.3;
  settings.clearance_weight = 100.0;
  const auto nearest = [&](const Clearances& clearances) {
    const Smoothed result =
        smooth(around_the_wall(), toy.weights, toy.lower, toy.upper, toy.world(), nullptr, clearances, settings);
    double least = INFINITY;
    for (const auto& row : result.path.waypoints.rowwise()) {
      least = std::min(least, from_disc(row.transpose(), nullptr)[0]);
    }
    return least;
  };
  EXPECT_GT(nearest(from_disc), 0.2);
  EXPECT_LT(nearest({}), 0.1);  // the companion
}

TEST(Smooth, KeepsTheLawOfTheBoxes) {
  ToyWorld toy;
  const PlanningGroup& hand = toy.hand;
  Eigen::MatrixXd waypoints(5, 4);  // up to row 2 along h2 = 0, then along h2 = 0.5
  waypoints << -1, -1, -0.7, 0, -1, 1, 0.6, 0.05, 0, 1, 0.7, 0.2, 1, 1.2, 0.1, 0.5, 1, -1, -0.7, 0.45;
  const JointPath path{toy.names, waypoints};
  const FollowedBoxes boxes =
      followed_boxes(waypoints, 2, box_distance(line_box(0.0), hand), box_distance(line_box(0.5), hand));
  const Smoothed result = smooth(path, toy.weights, toy.lower, toy.upper, toy.world(), &boxes, {}, {});
  EXPECT_LT(result.after.bending, result.before.bending);
  EXPECT_TRUE(change_row(boxes, result.path.waypoints));
  FollowedBoxes tight = boxes;
  tight.start_limit = 0.04;
  EXPECT_THROW(smooth(path, toy.weights, toy.lower, toy.upper, toy.world(), &tight, {}, {}), std::invalid_argument);
}

TEST(Smooth, NothingToDoOrNothingAllowed) {
  const ToyWorld toy;
  JointPath straight{toy.names, Eigen::MatrixXd(3, 4)};
  straight.waypoints << -1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0;
  EXPECT_EQ(smooth(straight, toy.weights, toy.lower, toy.upper, toy.world(), nullptr, {}, {}).path.waypoints,
            straight.waypoints);
  World refuses = toy.world();
  refuses.first_invalid = [](const Eigen::VectorXd&, const Eigen::VectorXd&, std::int64_t&) {
    return std::optional<double>(1.0);
  };
  const Smoothed refused = smooth(around_the_wall(), toy.weights, toy.lower, toy.upper, refuses, nullptr, {}, {});
  EXPECT_EQ(refused.path.waypoints, around_the_wall().waypoints);
  EXPECT_EQ(refused.moved, 0);
  SmoothSettings settings;
  settings.points = 1;
  EXPECT_THROW(validate(settings), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::motion
