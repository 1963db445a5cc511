// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The continuous check never proves what dense samples of exact distances refute, and verify agrees with it.
#include "motion/continuous_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "motion/edge_check.hpp"
#include "robot/load_robot.hpp"
#include "tests/verify/gantry.hpp"
#include "tests/verify/prove.hpp"

namespace opponens::motion {
namespace {

using Eigen::VectorXd;
using verify::Motion;

const std::string kSource = OPPONENS_SOURCE_DIR;
const std::string kShelf = kSource + "/models/scenes/bottle_shelf.yaml";
constexpr double kClearance = 0.0006;  // m
constexpr double kEndsOnly = 100.0;    // rad, a spacing of samples
constexpr double kWithin = 2e-6;       // m, of the distances on either side

/// From near a configuration that is near to much, 0.02 to 0.4 rad in a random direction.
Motion random_motion(const robot::RobotModel& robot, const VectorXd& about, Rng& rng) {
  const double spread = std::pow(10.0, rng.uniform(-1.5, 0.3));
  Motion motion{about, {}};
  VectorXd direction(about.size());
  for (Eigen::Index j = 0; j < about.size(); ++j) {
    motion.from[j] += spread * rng.normal();
    direction[j] = rng.normal();
  }
  motion.from = robot.clip(motion.from);
  direction *= 0.02 * std::pow(20.0, rng.uniform()) / direction.norm();
  motion.to = robot.clip(motion.from + direction);
  return motion;
}

/// The end of a motion into a collision, cut off shortly before it: about half of these come nearer than the clearance.
Motion grazing_motion(const robot::RobotModel& robot, const robot::CollisionChecker& checker, const VectorXd& about,
                      Rng& rng) {
  while (true) {
    const VectorXd clear = random_motion(robot, about, rng).from;
    const VectorXd step = random_motion(robot, about, rng).from - clear;
    if (!checker.free(clear) || checker.free(clear + step)) continue;
    double free = 0.0;
    double touching = 1.0;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (free + touching);
      (checker.free(clear + middle * step) ? free : touching) = middle;
    }
    const double end = free - std::pow(10.0, rng.uniform(-5.0, -1.5));
    const double begin = end - 0.05;
    if (begin > 0.0) return {clear + begin * step, clear + end * step};
  }
}

/// Least exact distance of any pair at equally spaced samples, m.
double sampled_clearance(const robot::CollisionChecker& checker, const Motion& motion, int samples) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= samples; ++i) {
    const double s = static_cast<double>(i) / samples;
    least = std::min(least, checker.clearance(motion.from + s * (motion.to - motion.from)).distance);
  }
  return least;
}

struct Tally {
  int free = 0;      ///< motions free at the planner's samples
  int proven = 0;    ///< of these
  int refuted = 0;   ///< of the proven, by dense samples
  int refused = 0;   ///< of the proven, by verify
  int grazing = 0;   ///< free motions whose dense samples come nearer than the clearance
  std::string text;  ///< the last one that should not have been proven
};

struct Problem {
  robot::RobotModel robot;
  robot::Scene scene;
  VectorXd about;
};

/// Motions that are free at the planner's samples, or just at their beginning, until there are so many.
Tally try_motions(const Problem& problem, int motions, int samples, const std::function<Motion()>& next,
                  double bound_factor = 1.0, double spacing = 0.02) {
  const robot::RobotModel& robot = problem.robot;
  const robot::CollisionChecker checker(robot, problem.scene);
  ClearanceSettings settings;
  settings.bound_factor = bound_factor;
  const ContinuousCheck check(checker, robot, settings);
  const robot::MotionBound bound(robot);
  verify::Bodies bodies(robot, problem.scene);
  Tally tally;
  for (int tries = 0; tally.free < motions && tries < 100 * motions; ++tries) {
    const Motion motion = next();
    std::int64_t checks = 0;
    if (!checker.free(motion.from) ||
        first_invalid(motion.from, motion.to, checker, robot.weights(), spacing, checks)) {
      continue;
    }
    ++tally.free;
    const double sampled = sampled_clearance(checker, motion, samples);
    if (sampled < kClearance) ++tally.grazing;
    if (check.first_near(motion.from, motion.to, checks)) continue;
    ++tally.proven;
    const bool refuted = sampled < kClearance - kWithin;
    const bool refused = !verify::prove(robot, bound, bodies, motion).passed;
    tally.refuted += refuted ? 1 : 0;
    tally.refused += refused ? 1 : 0;
    if (!refuted && !refused) continue;
    std::ostringstream text;
    text << sampled << " m: " << motion.from.transpose() << " to " << motion.to.transpose();
    tally.text = text.str();
  }
  return tally;
}

void expect_sound(const Tally& tally) {
  EXPECT_EQ(tally.refuted, 0) << tally.text;
  EXPECT_EQ(tally.refused, 0) << tally.text;
  EXPECT_GT(tally.proven, tally.free / 4) << "of " << tally.free;
  ::testing::Test::RecordProperty("free", tally.free);
  ::testing::Test::RecordProperty("proven", tally.proven);
  ::testing::Test::RecordProperty("grazing", tally.grazing);
}

VectorXd start_of(const robot::RobotModel& robot, const robot::Scene& scene) { return robot.clip(scene.start); }

TEST(ContinuousCheck, NeverProvesWhatSamplesOrVerifyRefuseOurs) {
  Problem problem{robot::RobotModel(robot::load_robot(kSource + "/models/ur5_allegro/ur5_allegro_right.yaml")),
                  robot::load_scene(kShelf),
                  {}};
  problem.about = start_of(problem.robot, problem.scene);
  const robot::CollisionChecker checker(problem.robot, problem.scene);
  Rng rng = stream(21, "test/continuous/ours");
  expect_sound(try_motions(problem, 200, 50, [&] { return random_motion(problem.robot, problem.about, rng); }));
  const Tally tally =
      try_motions(problem, 200, 50, [&] { return grazing_motion(problem.robot, checker, problem.about, rng); });
  expect_sound(tally);
  EXPECT_GT(tally.grazing, 20) << "little to refuse was tried";
}

TEST(ContinuousCheck, NeverProvesWhatSamplesOrVerifyRefuseLaboratory) {
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no shared data";
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  Problem problem{
      robot::RobotModel(robot::load_robot(kSource + "/tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml")),
      robot::load_scene(kShelf),
      {}};
  problem.about = start_of(problem.robot, problem.scene);
  problem.about[0] -= 0.25 * M_PI;  // its shoulder pan is zero 45 degrees away from ours
  Rng rng = stream(22, "test/continuous/laboratory");
  expect_sound(try_motions(problem, 20, 10, [&] { return random_motion(problem.robot, problem.about, rng); }));
}

/// Arms of one robot come near to each other: pairs of links, which no growing of the scene guards.
TEST(ContinuousCheck, NeverProvesWhatSamplesOrVerifyRefuseOfTwoArms) {
  Problem problem{robot::RobotModel(robot::load_robot(kSource + "/models/dual_ur5_allegro/dual_ur5_allegro.yaml")),
                  robot::Scene{},
                  {}};
  problem.about = problem.robot.clip(VectorXd::Zero(problem.robot.dof()));
  Rng rng = stream(23, "test/continuous/two arms");
  expect_sound(try_motions(problem, 60, 30, [&] { return random_motion(problem.robot, problem.about, rng); }));
}

/// A ball among thin plates: many motions pass a plate, and the bound of a sliding ball is tight.
Problem plates() {
  Rng rng = stream(24, "test/continuous/plates");
  Problem problem{verify::gantry(), robot::Scene{}, VectorXd::Zero(3)};
  for (int i = 0; i < 6; ++i) {
    problem.scene.bodies.push_back(verify::body("plate" + std::to_string(i),
                                                robot::Box{Eigen::Vector3d(0.001, 0.2, 0.2)},
                                                {rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), 0}));
  }
  return problem;
}

Tally try_plates(double bound_factor) {
  const Problem problem = plates();
  Rng rng = stream(25, "test/continuous/plates/motions");
  const auto any = [&] {
    return Motion{VectorXd(Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))),
                  VectorXd(Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)))};
  };
  return try_motions(problem, 300, 1000, any, bound_factor, kEndsOnly);
}

TEST(ContinuousCheck, ProvesNoMotionThroughAPlate) {
  const Tally tally = try_plates(1.0);
  EXPECT_EQ(tally.refuted, 0) << tally.text;
  EXPECT_EQ(tally.refused, 0) << tally.text;
  EXPECT_GT(tally.proven, 30);
  EXPECT_GT(tally.grazing, 30);
}

/// The companion: with half of the bound on travel, motions through plates are taken for proven.
TEST(ContinuousCheck, HalfTheBoundProvesWhatIsFalse) { EXPECT_GT(try_plates(0.5).refuted, 0); }

/// Every motion is either proven or comes near: where dense samples keep 10 um more than the clearance and the ends of
/// what is halved are as short as the resolution, nothing is refused.
TEST(ContinuousCheck, RefusesOnlyWhatComesNear) {
  const Problem problem = plates();
  const robot::CollisionChecker checker(problem.robot, problem.scene);
  const ContinuousCheck check(checker, problem.robot);
  Rng rng = stream(26, "test/continuous/refused");
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    const Motion motion{VectorXd(Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))),
                        VectorXd(Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)))};
    std::int64_t checks = 0;
    const auto near = check.first_near(motion.from, motion.to, checks);
    if (!near) continue;
    ++refused;
    const VectorXd q = motion.from + *near * (motion.to - motion.from);
    EXPECT_LT(checker.clearance(q).distance, kClearance + 3e-5) << q.transpose();
  }
  EXPECT_GT(refused, 20);
}

/// A start nearer than the clearance: that pair keeps nine tenths of what it has, all others the clearance.
TEST(ContinuousCheck, AStartThatIsTooNearMayLeaveButNotComeNearer) {
  Problem problem{verify::gantry(), robot::Scene{}, {}};
  problem.scene.bodies = {verify::body("wall", robot::Box{Eigen::Vector3d(0.1, 1, 1)}, {-0.1003, 0, 0})};  // 0.3 mm
  const robot::CollisionChecker checker(problem.robot, problem.scene);
  const ContinuousCheck strict(checker, problem.robot);
  const VectorXd start = Eigen::Vector3d::Zero();
  const ContinuousCheck check = strict.starting_at(start);
  EXPECT_EQ(check.pairs_nearer_at_start(), 1);
  EXPECT_FALSE(strict.keeps(start));
  EXPECT_TRUE(check.keeps(start));
  std::int64_t checks = 0;
  EXPECT_TRUE(strict.first_near(start, Eigen::Vector3d(0.1, 0, 0), checks));
  EXPECT_FALSE(check.first_near(start, Eigen::Vector3d(0.1, 0, 0), checks)) << "away";
  EXPECT_FALSE(check.first_near(start, Eigen::Vector3d(0, 0.3, 0), checks)) << "along";
  EXPECT_TRUE(check.first_near(start, Eigen::Vector3d(-0.0001, 0, 0), checks)) << "towards";
  EXPECT_FALSE(check.keeps(Eigen::Vector3d(-0.0001, 0, 0)));
}

TEST(ContinuousCheck, SameAnswerWhateverWasAskedBefore) {
  const robot::RobotModel robot(robot::load_robot(kSource + "/models/ur5_allegro/ur5_allegro_right.yaml"));
  const robot::Scene scene = robot::load_scene(kShelf);
  const robot::CollisionChecker checker(robot, scene);
  const ContinuousCheck check(checker, robot);
  Rng rng = stream(27, "test/continuous/again");
  std::vector<Motion> motions;
  for (int i = 0; i < 30; ++i) motions.push_back(random_motion(robot, start_of(robot, scene), rng));
  const auto ask = [&](const Motion& motion) {
    std::int64_t checks = 0;
    const auto near = check.first_near(motion.from, motion.to, checks);
    return std::make_pair(near, checks);
  };
  std::vector<std::pair<std::optional<double>, std::int64_t>> forwards;
  for (const Motion& motion : motions) forwards.push_back(ask(motion));
  for (std::size_t i = motions.size(); i-- > 0;) EXPECT_EQ(ask(motions[i]), forwards[i]) << i;
}

}  // namespace
}  // namespace opponens::motion
