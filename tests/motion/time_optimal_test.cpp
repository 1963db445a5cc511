// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/time_optimal.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "motion/half_planes.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

/// Free, whatever the number of joints.
World free_world() {
  World world;
  world.first_invalid = [](const Eigen::VectorXd&, const Eigen::VectorXd&, std::int64_t&) {
    return std::optional<double>();
  };
  return world;
}

struct Problem {
  Eigen::MatrixXd waypoints;
  RateLimits limits;
};

Problem random_problem(std::uint64_t seed) {
  Rng rng = stream(seed, "test/time_optimal");
  const auto d = static_cast<Eigen::Index>(1 + rng.index(22));
  const auto rows = static_cast<Eigen::Index>(2 + rng.index(12));
  Problem problem{Eigen::MatrixXd(rows, d), {Eigen::VectorXd(d), Eigen::VectorXd(d)}};
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < d; ++j) problem.waypoints(i, j) = rng.uniform(-2.0, 2.0);
  }
  // Among them nearly straight corners and short segments.
  for (Eigen::Index i = 2; i < rows; ++i) {
    if (rng.uniform() > 0.3) continue;
    const double share = std::pow(10.0, rng.uniform(-4.0, 0.0));
    problem.waypoints.row(i) =
        problem.waypoints.row(i - 1) +
        share * (problem.waypoints.row(i - 1) - problem.waypoints.row(i - 2) + 0.2 * problem.waypoints.row(i));
  }
  for (Eigen::Index j = 0; j < d; ++j) {
    problem.limits.velocity[j] = rng.uniform(0.2, 4.0);
    problem.limits.acceleration[j] = rng.uniform(0.5, 20.0);
  }
  return problem;
}

/// The largest share of the limits that finite differences of the positions use: of velocity and of acceleration.
Eigen::Vector2d used(const Trajectory& trajectory, const RateLimits& limits) {
  constexpr double kStep = 1e-4;  // s
  const double end = trajectory.times[trajectory.times.size() - 1];
  Eigen::Vector2d largest(0.0, 0.0);
  for (int k = 0; k < 4000; ++k) {
    const double t = kStep + (end - 2.0 * kStep) * k / 4000.0;
    const Eigen::RowVectorXd before = state_at(trajectory, t - kStep).row(0);
    const Eigen::RowVectorXd now = state_at(trajectory, t).row(0);
    const Eigen::RowVectorXd after = state_at(trajectory, t + kStep).row(0);
    const Eigen::VectorXd velocity = (after - before).transpose() / (2.0 * kStep);
    const Eigen::VectorXd acceleration = (after - 2.0 * now + before).transpose() / (kStep * kStep);
    largest[0] = std::max(largest[0], (velocity.array().abs() / limits.velocity.array()).maxCoeff());
    largest[1] = std::max(largest[1], (acceleration.array().abs() / limits.acceleration.array()).maxCoeff());
  }
  return largest;
}

TEST(TimeOptimal, FiniteDifferencesStayWithinTheLimits) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Problem problem = random_problem(seed);
    const BlendedPath path = blend_corners(problem.waypoints, free_world(), {});
    const Trajectory trajectory = time_optimal(path, problem.limits, {});
    const Eigen::Vector2d shares = used(trajectory, problem.limits);
    EXPECT_LE(shares[0], 1.01) << "seed " << seed;
    EXPECT_LE(shares[1], 1.01) << "seed " << seed;
    // The companion: half the limits are not kept.
    const Eigen::Vector2d of_half =
        used(trajectory, {0.5 * problem.limits.velocity, 0.5 * problem.limits.acceleration});
    EXPECT_GT(of_half.maxCoeff(), 1.9) << "seed " << seed;
  }
}

TEST(TimeOptimal, EverywhereSomeLimitIsUsedUpAndNoLowerBoundIsBroken) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Problem problem = random_problem(seed);
    const Trajectory trajectory = time_optimal(blend_corners(problem.waypoints, free_world(), {}), problem.limits, {});
    const Eigen::Index last = trajectory.times.size() - 1;
    EXPECT_GE(trajectory.times[last], least_duration(trajectory.positions, problem.limits)) << "seed " << seed;
    const Trajectory stopping = time_optimal(stop_at_corners(problem.waypoints), problem.limits, {});
    EXPECT_LE(trajectory.times[last], stopping.times[stopping.times.size() - 1] + 1e-9) << "seed " << seed;
    double unused = 0.0;  // s, in chords where up changes to down: the acceleration is constant in a chord
    for (Eigen::Index i = 0; i < last; ++i) {
      ASSERT_GT(trajectory.times[i + 1], trajectory.times[i]);
      // Bang-bang: a fastest motion uses up some limit at each time (Bobrow, Dubowsky and Gibson 1985).
      double use = 0.0;
      for (const double share : {1e-6, 0.5, 1.0 - 1e-6}) {
        const double t = trajectory.times[i] + share * (trajectory.times[i + 1] - trajectory.times[i]);
        const Eigen::MatrixXd state = state_at(trajectory, t);
        use = std::max({use, (state.row(1).transpose().array().abs() / problem.limits.velocity.array()).maxCoeff(),
                        (state.row(2).transpose().array().abs() / problem.limits.acceleration.array()).maxCoeff()});
      }
      if (use < 0.95) unused += trajectory.times[i + 1] - trajectory.times[i];
    }
    EXPECT_LE(unused, 0.01 * trajectory.times[last]) << "seed " << seed;
  }
}

TEST(TimeOptimal, AStraightPathTakesTheKnownTime) {
  Eigen::MatrixXd waypoints(2, 2);
  waypoints << 0, 0, 3, 1;
  const RateLimits limits{Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(2.0, 2.0)};
  BlendSettings settings;
  settings.arc_step = 1e-6;  // nothing is taken off the limits
  const Trajectory trajectory = time_optimal(stop_at_corners(waypoints), limits, settings);
  EXPECT_NEAR(trajectory.times[trajectory.times.size() - 1], 3.5, 1e-9);  // 3 / v + v / a
  EXPECT_EQ(trajectory.times.size(), 4);
  EXPECT_NEAR(trajectory.times[trajectory.times.size() - 1], least_duration(waypoints, limits), 1e-9);
  EXPECT_NEAR(state_at(trajectory, 0.25)(0, 0), 0.0625, 1e-9);
}

TEST(TimeOptimal, AtRestAtTheEndsAndAtStops) {
  const Problem problem = random_problem(5);
  const Trajectory trajectory = time_optimal(stop_at_corners(problem.waypoints), problem.limits, {});
  Eigen::Index found = 0;
  for (Eigen::Index i = 0; i < trajectory.times.size(); ++i) {
    if (found < problem.waypoints.rows() &&
        (trajectory.positions.row(i) - problem.waypoints.row(found)).norm() < 1e-9) {
      EXPECT_EQ(trajectory.velocities.row(i).norm(), 0.0);
      ++found;
    }
  }
  EXPECT_EQ(found, problem.waypoints.rows());
  const Trajectory both =
      joined(trajectory, time_optimal(stop_at_corners(problem.waypoints.colwise().reverse()), problem.limits, {}));
  EXPECT_EQ(both.times.size(), 2 * trajectory.times.size() - 1);
  EXPECT_TRUE((both.times.tail(both.times.size() - 1).array() > both.times.head(both.times.size() - 1).array()).all());
  EXPECT_THROW(joined(trajectory, trajectory), std::invalid_argument);
}

TEST(TimeOptimal, RefusesBadLimits) {
  const BlendedPath path = stop_at_corners(random_problem(2).waypoints);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(random_problem(2).waypoints.cols());
  EXPECT_THROW(time_optimal(path, {ones, 0.0 * ones}, {}), std::invalid_argument);
  EXPECT_THROW(time_optimal(path, {INFINITY * ones, ones}, {}), std::invalid_argument);
  EXPECT_THROW(time_optimal({}, {ones, ones}, {}), std::invalid_argument);
}

TEST(BlendCorners, ContinuousWithinTheDeviationAndOnThePath) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Problem problem = random_problem(seed);
    for (const double deviation : {0.02, 0.1, 0.5}) {
      BlendSettings settings;
      settings.deviation = deviation;
      const BlendedPath path = blend_corners(problem.waypoints, free_world(), settings);
      EXPECT_EQ(path.corners, problem.waypoints.rows() - 2);
      Eigen::VectorXd at = problem.waypoints.row(0).transpose();
      for (std::size_t i = 0; i < path.pieces.size(); ++i) {
        const PathPiece& piece = path.pieces[i];
        ASSERT_LT((position(piece, 0.0) - at).norm(), 1e-7) << "seed " << seed;
        at = position(piece, piece.length);
        if (i + 1 < path.pieces.size() && !piece.rest) {
          ASSERT_LT((direction(piece, piece.length) - direction(path.pieces[i + 1], 0.0)).norm(), 1e-6);
        }
        if (piece.radius == 0.0) continue;
        const Eigen::VectorXd corner = problem.waypoints.row(piece.row).transpose();
        EXPECT_LE((position(piece, 0.5 * piece.length) - corner).norm(), deviation * (1.0 + 1e-9));
      }
      EXPECT_LT((at - problem.waypoints.bottomRows(1).transpose()).norm(), 1e-7);
    }
  }
}

TEST(BlendCorners, ShrinkWhereTheyCollideDownToAStop) {
  // Around the corner of an obstacle, at (0, 0), with a gap: a blend cuts the corner by half the deviation and more.
  for (const double gap : {1.0, 0.05, 0.01, 1e-6}) {
    ToyWorld toy;
    toy.obstacles.push_back({{-gap - 1.0, gap, -2, -2}, {-gap, 1.5, 2, 2}});
    Eigen::MatrixXd waypoints(3, 4);
    waypoints << -1.5, 0, 0, 0, 0, 0, 0, 0, 0, 1.9, 0, 0;
    const World world = toy.world(0.001);
    const BlendedPath path = blend_corners(waypoints, world, {});
    const auto arc =
        std::find_if(path.pieces.begin(), path.pieces.end(), [](const PathPiece& piece) { return piece.radius > 0.0; });
    EXPECT_EQ(path.stops, gap < 1e-3 ? 1 : 0) << gap;
    EXPECT_EQ(arc == path.pieces.end(), gap < 1e-3) << gap;
    if (arc == path.pieces.end()) continue;
    for (double s = 0.0; s <= arc->length; s += arc->length / 1000.0) ASSERT_TRUE(toy.valid(position(*arc, s)));
    // The companion: as the deviation asks, it would collide (but for the widest gap).
    const BlendedPath blind = blend_corners(waypoints, free_world(), {});
    bool collides = false;
    for (double s = 0.0; s <= blind.pieces[1].length; s += 1e-4) {
      collides = collides || !toy.valid(position(blind.pieces[1], s));
    }
    EXPECT_EQ(collides, gap < 0.06) << gap;
  }
}

TEST(BlendCorners, WaypointsThatRepeatAreLeftOut) {
  Eigen::MatrixXd waypoints(6, 2);
  waypoints << 0, 0, 1e-12, 0, 1, 0, 1, 1e-11, 2, 1, 2, 1 + 1e-12;
  Eigen::MatrixXd expected(3, 2);
  expected << 0, 0, 1, 0, 2, 1 + 1e-12;
  EXPECT_EQ(distinct(waypoints), expected);
  EXPECT_EQ(distinct(waypoints.topRows(2)), waypoints.topRows(1));
  EXPECT_THROW(blend_corners(waypoints, free_world(), {}), std::invalid_argument);
  EXPECT_EQ(blend_corners(distinct(waypoints), free_world(), {}).corners, 1);
}

TEST(BlendCorners, SegmentsHardlyLongerThanNothingLeaveStraightEnds) {
  const RateLimits limits{Eigen::Vector2d::Ones(), Eigen::Vector2d::Ones()};
  for (const double tiny : {1.1e-9, 1.5e-9, 1.9e-9, 2.5e-9, 1e-8, 1e-6}) {
    Eigen::MatrixXd waypoints(4, 2);
    waypoints << 0.0, 0.0, 0.0, tiny, 1.0, tiny, 1.0, 2.0 * tiny;
    const BlendedPath path = blend_corners(waypoints, free_world(), {});
    EXPECT_EQ(path.pieces.front().radius, 0.0) << tiny;
    EXPECT_EQ(path.pieces.back().radius, 0.0) << tiny;
    const Trajectory trajectory = time_optimal(path, limits, {});
    EXPECT_GT(trajectory.times[trajectory.times.size() - 1], 1.9) << tiny;  // 1 rad at 1 rad/s and 1 rad/s^2 takes 2 s
    EXPECT_LT(trajectory.times[trajectory.times.size() - 1], 2.2) << tiny;
  }
}

TEST(BlendCorners, ATurnBackIsAStopAndAStraightCornerIsNone) {
  Eigen::MatrixXd waypoints(4, 2);
  waypoints << 0, 0, 1, 0, 2, 0, 0.5, 0;
  const BlendedPath path = blend_corners(waypoints, free_world(), {});
  EXPECT_EQ(path.stops, 1);
  EXPECT_EQ(path.pieces.size(), 3U);
  EXPECT_FALSE(path.pieces[0].rest);
  EXPECT_TRUE(path.pieces[1].rest);
  waypoints.row(1) = waypoints.row(0);
  EXPECT_THROW(blend_corners(waypoints, free_world(), {}), std::invalid_argument);
}

TEST(HalfPlanes, LargestXAgreesWithAllPairsOfBorders) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Rng rng = stream(seed, "test/half_planes");
    std::vector<HalfPlane> planes{{1, 0, 3}, {-1, 0, 3}, {0, 1, 3}, {0, -1, 3}};
    const std::uint64_t more = rng.index(12);
    for (std::uint64_t i = 0; i < more; ++i) planes.push_back({rng.normal(), rng.normal(), rng.normal() + 0.7});
    double best = -INFINITY;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double det = planes[i].a * planes[j].b - planes[j].a * planes[i].b;
        if (det == 0.0) continue;
        const double x = (planes[i].c * planes[j].b - planes[j].c * planes[i].b) / det;
        const double u = (planes[i].a * planes[j].c - planes[j].a * planes[i].c) / det;
        const bool kept = std::all_of(planes.begin(), planes.end(), [&](const HalfPlane& plane) {
          return plane.a * x + plane.b * u <= plane.c + 1e-9;
        });
        if (kept) best = std::max(best, x);
      }
    }
    const auto found = largest_x(planes);
    ASSERT_EQ(found.has_value(), std::isfinite(best)) << "seed " << seed;
    if (!found) continue;
    EXPECT_NEAR(*found, best, 1e-6) << "seed " << seed;
    const Interval u = range_of_u(planes, *found - 1e-6);
    EXPECT_LE(u.lower, u.upper + 1e-5);
    EXPECT_TRUE(range_of_u(planes, *found + 1e-3).empty());
  }
}

}  // namespace
}  // namespace opponens::motion
