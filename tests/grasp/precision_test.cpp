// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/precision_search.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "allegro.hpp"
#include "core/rng.hpp"
#include "grasp/tip_seed.hpp"
#include "random_contacts.hpp"
#include "recheck.hpp"

namespace opponens::grasp {
namespace {

/// An object with everything a precision search reads.
struct Bench {
  explicit Bench(robot::Scene made, SynergyBox chosen = free_box(test::allegro()), TipModel tips = TipModel::ball,
                 PrecisionGoal goal = PrecisionGoal::min_weight)
      : scene(std::move(made)),
        box(std::move(chosen)),
        target(make_target(scene, "object", 2)),
        surface(hand_surface(test::allegro(), test::allegro().clip(box.scale.cwiseProduct(box.center)))),
        space(make_precision_space(test::allegro(), surface, target, box, tips, default_convention(target, 0.5), goal,
                                   0.001)) {}
  robot::Scene scene;
  SynergyBox box;
  GraspTarget target;
  HandSurface surface;
  PrecisionSpace space;
};

robot::Scene brick_on_a_table() {
  return test::with_table(test::scene_of(robot::Box{Eigen::Vector3d(0.05, 0.08, 0.06)}), -0.03);
}

TEST(TipField, SlopesEqualCentralDifferences) {
  const Bench bench(test::scene_of(robot::Box{Eigen::Vector3d(0.05, 0.08, 0.06)}));
  Rng rng = stream(71, "field");
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = rng.uniform(0.02, i % 4 == 0 ? 0.25 : 0.09) * test::random_unit(rng);
    const FieldSample at = bench.space.field.query(p);
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(j);
      const FieldSample up = bench.space.field.query(p + step);
      const FieldSample down = bench.space.field.query(p - step);
      EXPECT_NEAR(at.gradient[j], (up.value - down.value) / 2e-6, 1e-5) << p.transpose();
      const Eigen::Vector3d turn = (up.gradient - down.gradient) / 2e-6;
      EXPECT_LT((at.hessian.col(j) - turn).norm(), 1e-3 * (1.0 + at.hessian.norm())) << p.transpose();
    }
  }
}

TEST(TipField, KeepsAFlatFaceAndMovesABallByItsCurvature) {
  const Bench brick(test::scene_of(robot::Box{Eigen::Vector3d(0.05, 0.08, 0.06)}));
  EXPECT_NEAR(brick.space.field.query({0.025 + 0.012, 0.0, 0.0}).value, 0.012, 1e-6);
  const Bench ball(test::scene_of(robot::Sphere{0.035}));
  const double h = ball.target.grid->spacing();
  const double moved = h * h / 3.0 / 0.047;  // twice h^2/6 times the curvature at 12 mm from the ball
  EXPECT_NEAR(ball.space.field.query({0.0, 0.047, 0.0}).value, 0.012, 3.0 * moved + 3e-4);
}

TEST(FingerTips, AreTheSpheresOrTheirFits) {
  const HandSurface surface = hand_surface(test::allegro(), Eigen::VectorXd::Zero(16));
  const auto balls = finger_tips(test::allegro(), surface, TipModel::ball);
  ASSERT_EQ(balls.size(), 4u);
  for (const FingerTip& tip : balls) {
    EXPECT_TRUE(tip.exact);
    EXPECT_DOUBLE_EQ(tip.radius, 0.012);
    EXPECT_NEAR(tip.center_L.norm(), 0.0, 1e-12);
  }
  for (const FingerTip& tip : finger_tips(test::allegro(), surface, TipModel::fixed_point)) EXPECT_EQ(tip.radius, 0.0);
  // The same hand with its tips as meshes.
  robot::RobotDescription meshed = test::allegro().description();
  for (robot::Link& link : meshed.links) {
    for (robot::Geometry& geometry : link.collision) {
      if (!std::holds_alternative<robot::Sphere>(geometry.shape)) continue;
      geometry.shape = std::make_shared<const robot::TriangleMesh>(robot::triangulate(geometry.shape, 64));
    }
  }
  const robot::RobotModel hand(meshed);
  const HandSurface skin = hand_surface(hand, Eigen::VectorXd::Zero(16));
  const GraspTarget target = make_target(test::scene_of(robot::Sphere{0.035}), "object", 2);
  const auto fits = finger_tips(hand, skin, TipModel::ball);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    EXPECT_FALSE(fits[i].exact);
    EXPECT_NEAR(fits[i].radius, 0.012, 5e-4);
    Eigen::Isometry3d X_OL = Eigen::Isometry3d::Identity();
    X_OL.translation() = Eigen::Vector3d(-0.040, 0.012, 0.005);
    X_OL.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const TipTouch exact = touch(balls[i], surface, target, X_OL);
    const TipTouch fitted = touch(fits[i], skin, target, X_OL);
    EXPECT_NEAR(fitted.gap, exact.gap, 1e-4);
    EXPECT_LT((fitted.p_O - exact.p_O).norm(), 2e-3);
  }
}

TEST(QualitySlope, EqualsCentralDifferences) {
  Rng rng = stream(72, "wrenches");
  for (const PrecisionGoal goal : {PrecisionGoal::min_weight, PrecisionGoal::epsilon}) {
    double largest = 0.0;
    for (int i = 0; i < 20; ++i) {
      Matrix6Xd wrenches(6, 16);
      for (Eigen::Index j = 0; j < wrenches.size(); ++j) wrenches.data()[j] = rng.normal();
      const QualitySlope at = quality_slope(wrenches, goal);
      ASSERT_TRUE(at.known);
      for (Eigen::Index j = 0; j < wrenches.size(); ++j) {
        Matrix6Xd up = wrenches;
        Matrix6Xd down = wrenches;
        up.data()[j] += 1e-6;
        down.data()[j] -= 1e-6;
        const double slope = (quality_slope(up, goal).value - quality_slope(down, goal).value) / 2e-6;
        EXPECT_NEAR(at.slope.data()[j], slope, 1e-5) << "set " << i << ", entry " << j;
        largest = std::max(largest, std::abs(slope));
      }
    }
    EXPECT_GT(largest, 0.01);
  }
  EXPECT_FALSE(quality_slope(Matrix6Xd::Zero(6, 8), PrecisionGoal::epsilon).known);
}

void expect_slopes(const Bench& bench, std::uint64_t seed) {
  Rng rng = stream(seed, "problem");
  PrecisionProblem problem(bench.space);
  int active = 0;
  for (int i = 0; i < 6; ++i) {
    const auto start = draw_tip_seed(bench.space, rng);
    ASSERT_TRUE(start.has_value());
    problem.place(*start);
    Eigen::VectorXd x(problem.size());
    for (Eigen::Index j = 0; j < 6; ++j) x[j] = rng.uniform(-0.2, 0.2);
    x.tail(start->y.size()) = start->y;
    const PrecisionValue at = problem.evaluate(x, true);
    active += static_cast<int>((at.excess_slopes.rowwise().norm().array() > 0.0).count());
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double h = 1e-7;
      Eigen::VectorXd up = x;
      Eigen::VectorXd down = x;
      up[j] += h;
      down[j] -= h;
      const PrecisionValue high = problem.evaluate(up, false);
      const PrecisionValue low = problem.evaluate(down, false);
      EXPECT_NEAR(at.quality_slope[j], (high.quality - low.quality) / (2.0 * h), 1e-4 * (1.0 + at.quality_slope.norm()))
          << "point " << i << ", coordinate " << j;
      const Eigen::VectorXd gaps = (high.gaps - low.gaps) / (2.0 * h);
      EXPECT_LT((at.gap_slopes.col(j) - gaps).norm(), 1e-4 * (1.0 + gaps.norm()))
          << "point " << i << ", coordinate " << j;
      const Eigen::VectorXd excess = (high.excess - low.excess) / (2.0 * h);
      for (Eigen::Index row = 0; row < excess.size(); ++row) {
        if (at.excess_slopes.row(row).isZero(0.0)) continue;  // far apart: a bound, without slope
        EXPECT_NEAR(at.excess_slopes(row, j), excess[row], 1e-3 * (1.0 + std::abs(excess[row])))
            << "point " << i << ", constraint " << row << ", coordinate " << j;
      }
    }
  }
  EXPECT_GT(active, 10);
}

TEST(PrecisionProblem, SlopesEqualCentralDifferencesForFreeJoints) { expect_slopes(Bench(brick_on_a_table()), 73); }

TEST(PrecisionProblem, SlopesForFixedPointsAndSynergiesBeyondTheLimits) {
  SynergyBox box = test::power_synergies().group.box;
  box.half_width *= 4.0;
  expect_slopes(Bench(brick_on_a_table(), box, TipModel::fixed_point), 74);
}

TEST(PrecisionRun, NeverKeepsAPointThatIsNotFinite) {
  const Bench bench(test::scene_of(robot::Sphere{0.035}));
  PrecisionProblem problem(bench.space);
  Rng rng = stream(75, "run");
  const auto seed = draw_tip_seed(bench.space, rng);
  ASSERT_TRUE(seed.has_value());
  PrecisionRun run(problem, *seed, bench.box);
  Eigen::VectorXd x = run.start();
  x[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(run.visit(x, true), nullptr);
  EXPECT_FALSE(run.best().has_value());
  EXPECT_NE(run.visit(run.start(), true), nullptr);
  x[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(run.visit(x, false), nullptr);
  ASSERT_TRUE(run.best().has_value());
  EXPECT_TRUE(run.best()->allFinite());
  HandSeed lost = *seed;
  lost.X_OH.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PrecisionRun(problem, lost, bench.box), std::invalid_argument);
}

TEST(PrecisionRun, EitherSolverComesNearerToAGrasp) {
  const Bench bench(test::scene_of(robot::Sphere{0.035}), test::power_synergies().group.box);
  PrecisionProblem problem(bench.space);
  Rng rng = stream(76, "run");
  const auto seed = draw_tip_seed(bench.space, rng);
  ASSERT_TRUE(seed.has_value());
  for (const PrecisionSolver solver : {PrecisionSolver::slsqp, PrecisionSolver::cobyla}) {
    PrecisionRun run(problem, *seed, bench.box);
    const double before = problem.evaluate(run.start(), false).violation();
    solve(run, problem, solver, 150);
    ASSERT_TRUE(run.best().has_value());
    EXPECT_LT(problem.evaluate(*run.best(), false).violation(), 0.8 * before);
  }
}

TEST(FreeBox, IsTheJointsThemselves) {
  const SynergyBox box = free_box(test::allegro());
  EXPECT_LT((box.center + box.half_width - test::allegro().upper()).norm(), 1e-12);
  EXPECT_LT((box.center - box.half_width - test::allegro().lower()).norm(), 1e-12);
  EXPECT_TRUE(box.axes.isIdentity(0.0));
  EXPECT_THROW(free_box(test::allegro().upper(), test::allegro().lower()), std::invalid_argument);
}

SynergyGroup group_of(SynergyBox box) {
  SynergyGroup group;
  group.name = "free";
  group.phase = "grasp";
  group.box = std::move(box);
  return group;
}

PrecisionSettings few(int enough) {
  PrecisionSettings settings;
  settings.count = 2;
  settings.enough = enough;
  settings.max_trials = 60;
  settings.threads = 2;
  return settings;
}

/// The promises of a grasp, by code that the search does not use.
void expect_grasps(const robot::Scene& scene, const SynergyGroup& group, const PrecisionSettings& settings) {
  const test::Synergies synergies = test::power_synergies();
  const SearchResult found =
      search_precision_grasps(test::allegro(), scene, "object", group, &synergies.pre_grasp, settings, 1);
  ASSERT_FALSE(found.grasps.empty());
  SearchSettings promised;
  promised.contact_tolerance = 2e-4;
  for (const Grasp& grasp : found.grasps) {
    EXPECT_EQ(grasp.contacts.size(), 4u);
    EXPECT_GT(grasp.quality.min_weight.value(), 0.0);
    test::recheck(grasp, test::allegro(), scene, group, promised);
  }
}

TEST(PrecisionSearch, SphereWithFreeJoints) {
  expect_grasps(test::scene_of(robot::Sphere{0.035}), group_of(free_box(test::allegro())), few(2));
}

TEST(PrecisionSearch, BoxOnATableWithFreeJoints) {
  expect_grasps(brick_on_a_table(), group_of(free_box(test::allegro())), few(2));
}

TEST(PrecisionSearch, EpsilonAsTheGoal) {
  PrecisionSettings settings = few(2);
  settings.goal = PrecisionGoal::epsilon;
  expect_grasps(test::scene_of(robot::Sphere{0.035}), group_of(free_box(test::allegro())), settings);
}

TEST(PrecisionSearch, TheAnswerDependsOnNoThreadCount) {
  const Bench bench(brick_on_a_table());
  const HandCheckers checkers = hand_checkers(test::allegro(), bench.scene, "object");
  const std::string name = "free";
  PrecisionSettings settings = few(3);
  settings.threads = 1;
  const SearchResult alone = search_precision_grasps({bench.space, settings, checkers, name, nullptr}, 4);
  settings.threads = 3;
  const SearchResult together = search_precision_grasps({bench.space, settings, checkers, name, nullptr}, 4);
  EXPECT_EQ(alone.trials, together.trials);
  EXPECT_EQ(alone.evaluations, together.evaluations);
  EXPECT_EQ(alone.rejected, together.rejected);
  ASSERT_FALSE(alone.grasps.empty());
  ASSERT_EQ(alone.grasps.size(), together.grasps.size());
  for (std::size_t i = 0; i < alone.grasps.size(); ++i) {
    EXPECT_EQ(alone.grasps[i].q_grasp, together.grasps[i].q_grasp);
    EXPECT_EQ(alone.grasps[i].X_OH.matrix(), together.grasps[i].X_OH.matrix());
  }
}

TEST(PrecisionSearch, AnObjectTooLargeIsACountedReason) {
  PrecisionSettings settings = few(2);
  settings.max_trials = 7;
  const SearchResult found = search_precision_grasps(test::allegro(), test::scene_of(robot::Sphere{0.25}), "object",
                                                     group_of(free_box(test::allegro())), nullptr, settings, 1);
  EXPECT_TRUE(found.grasps.empty());
  EXPECT_EQ(found.trials, 7);
  EXPECT_EQ(found.rejected.at("no chord through the object"), 7);
}

TEST(PrecisionSearch, SettingsAreValidated) {
  PrecisionSettings settings;
  settings.enough = settings.count - 1;
  EXPECT_THROW(validate(settings), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
