// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/followed_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "core/rng.hpp"
#include "motion/blended_path.hpp"
#include "motion/shortcut.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

const PlanningGroup kArm{"arm", {"x", "y"}, 0, 2};

/// The line { (h1, y) : |y| <= 0.8 } in the hand's plane, across line_box.
SynergyBox cross_box(double h1) {
  SynergyBox box = line_box(0.0);
  box.center = Eigen::Vector2d(h1, 0.0);
  box.axes = Eigen::Vector2d(0.0, 1.0);
  return box;
}

/// A planned path that followed h2 = 0 and then h1 = 0.8, round a corner of the hand's plane; a wall with a gap
/// between.
struct PlannedToy {
  ToyWorld toy;
  PlanResult planned;
  FollowedBoxes boxes;
};

PlannedToy planned_toy(std::uint64_t seed) {
  PlannedToy result;
  result.toy.add_wall(0.5, 1.5);
  PlannerSettings settings;
  settings.step = 0.2;
  settings.full_space_probability = 0.0;
  result.planned =
      plan_toy(result.toy, {-1, -1, -0.8, 0}, {{Eigen::Vector4d(1, -1, 0.8, 0.8), cross_box(0.8), 0}}, settings, seed);
  EXPECT_EQ(result.planned.status, PlanStatus::solved) << result.planned.detail;
  result.boxes =
      followed_boxes(result.planned.path.waypoints, result.planned.bridge_row,
                     box_distance(line_box(0.0), result.toy.hand), box_distance(cross_box(0.8), result.toy.hand));
  return result;
}

/// The law, by points on the path and not by its waypoints: a place exists before which no point is further from the
/// start's box than the planned path was, and after which none is further from the goal's.
bool keeps_law(const FollowedBoxes& boxes, const std::vector<Eigen::VectorXd>& points) {
  std::size_t last = 0;
  while (last < points.size() && boxes.start(points[last]) <= boxes.start_limit + 1e-8) ++last;
  std::size_t first = points.size();
  while (first > 0 && boxes.goal(points[first - 1]) <= boxes.goal_limit + 1e-8) --first;
  return first <= last;
}

std::vector<Eigen::VectorXd> points_of(const Eigen::MatrixXd& waypoints) {
  std::vector<Eigen::VectorXd> points;
  for (Eigen::Index i = 0; i + 1 < waypoints.rows(); ++i) {
    for (int k = 0; k < 100; ++k) {
      points.emplace_back(waypoints.row(i).transpose() +
                          k / 100.0 * (waypoints.row(i + 1) - waypoints.row(i)).transpose());
    }
  }
  points.emplace_back(waypoints.bottomRows(1).transpose());
  return points;
}

TEST(FollowedBoxes, DistanceIsHandComputedAndConvex) {
  const ToyWorld toy;
  const BoxDistance distance = box_distance(line_box(0.5), toy.hand);
  EXPECT_DOUBLE_EQ(distance(Eigen::Vector4d(1.7, 0, 0.3, 0.5)), 0.0);
  EXPECT_DOUBLE_EQ(distance(Eigen::Vector4d(0, 0, 1.1, 0.1)), 0.5);
  Rng rng = stream(3, "test/followed_boxes");
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector4d a = Eigen::Vector4d::NullaryExpr([&] { return rng.uniform(-2, 2); });
    const Eigen::Vector4d b = Eigen::Vector4d::NullaryExpr([&] { return rng.uniform(-2, 2); });
    const double share = rng.uniform();
    EXPECT_LE(distance(a + share * (b - a)), (1.0 - share) * distance(a) + share * distance(b) + 1e-12);
  }
}

TEST(FollowedBoxes, ShortcutsInBoxesKeepTheLawAndFreeOnesBreakIt) {
  int free_ones_break_it = 0;
  int shortened = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const PlannedToy p = planned_toy(seed);
    ASSERT_TRUE(keeps_law(p.boxes, points_of(p.planned.path.waypoints)));
    const Shortcut inside = shortcut_in_boxes(p.planned.path, p.toy.weights, p.toy.world(), p.boxes, kArm, seed);
    EXPECT_TRUE(keeps_law(p.boxes, points_of(inside.path.waypoints))) << "seed " << seed;
    EXPECT_LE(inside.length, inside.length_before);
    shortened += inside.length < 0.95 * inside.length_before;
    const World world = p.toy.world();
    std::int64_t checks = 0;
    for (Eigen::Index i = 1; i < inside.path.waypoints.rows(); ++i) {
      ASSERT_TRUE(valid_motion(world, inside.path.waypoints.row(i - 1).transpose(),
                               inside.path.waypoints.row(i).transpose(), checks));
    }
    EXPECT_EQ(inside.path.waypoints,
              shortcut_in_boxes(p.planned.path, p.toy.weights, p.toy.world(), p.boxes, kArm, seed).path.waypoints);
    const Shortcut outside = shortcut(p.planned.path, p.toy.weights, p.toy.world(), {}, seed);
    free_ones_break_it += !keeps_law(p.boxes, points_of(outside.path.waypoints));
  }
  EXPECT_GT(shortened, 20);
  EXPECT_GT(free_ones_break_it, 5);  // the companion
}

TEST(FollowedBoxes, BlendsKeepTheLaw) {
  int breaks_without = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const PlannedToy p = planned_toy(seed);
    BlendSettings settings;
    settings.deviation = 0.3;
    for (const bool with : {true, false}) {
      const BlendedPath path =
          blend_corners(p.planned.path.waypoints, p.toy.world(), settings, with ? &p.boxes : nullptr);
      std::vector<Eigen::VectorXd> points;
      for (const PathPiece& piece : path.pieces) {
        for (int k = 0; k < 50; ++k) points.push_back(position(piece, piece.length * k / 50.0));
      }
      points.push_back(position(path.pieces.back(), path.pieces.back().length));
      const bool keeps = keeps_law(p.boxes, points);
      EXPECT_TRUE(keeps || !with) << "seed " << seed;
      breaks_without += !keeps && !with;
    }
  }
  EXPECT_GT(breaks_without, 0);  // the companion
}

TEST(FollowedBoxes, RefusesAPathThatIsFurtherOff) {
  const PlannedToy p = planned_toy(1);
  JointPath path = p.planned.path;
  path.waypoints(0, 3) += 1.0;
  EXPECT_FALSE(change_row(p.boxes, path.waypoints));
  EXPECT_THROW(shortcut_in_boxes(path, p.toy.weights, p.toy.world(), p.boxes, kArm, 1), std::invalid_argument);
  EXPECT_THROW(followed_boxes(path.waypoints, -1, p.boxes.start, p.boxes.goal), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::motion
