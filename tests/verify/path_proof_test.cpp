// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What the proof is for: it catches what samples step over, and never passes what dense samples find in collision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <sstream>
#include <string>

#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"
#include "tests/verify/gantry.hpp"
#include "tests/verify/prove.hpp"

namespace opponens::verify {
namespace {

using Eigen::VectorXd;

const std::string kModels = OPPONENS_SOURCE_DIR "/models/";
constexpr double kDense = 1e-4;            // rad
constexpr double kTriangulation = 4.1e-5;  // m, of two round shapes

VectorXd random_configuration(const robot::RobotModel& robot, Rng& rng) {
  VectorXd q(robot.dof());
  for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng.uniform(robot.lower()[j], robot.upper()[j]);
  return q;
}

/// How often a scene's shelf and bottles are near: the arm reaches from the scene's start, more or less far.
Motion random_motion(const robot::RobotModel& robot, const VectorXd& about, Rng& rng) {
  const double spread = std::pow(10.0, rng.uniform(-1.5, 0.3));
  Motion motion{about, {}};
  for (Eigen::Index j = 0; j < about.size(); ++j) motion.from[j] += spread * rng.normal();
  motion.from = robot.clip(motion.from);
  VectorXd direction = random_configuration(robot, rng) - motion.from;
  direction *= 0.02 * std::pow(20.0, rng.uniform()) / direction.norm();  // 0.02 to 0.4 rad long
  motion.to = robot.clip(motion.from + direction);
  return motion;
}

int count_from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::max(1, std::atoi(text));
}

struct Tally {
  int segments = 0;
  int passed = 0;
  int wrong = 0;        ///< passed, but a dense sample is in collision
  std::string example;  ///< of those

  void record() const {
    ::testing::Test::RecordProperty("segments", segments);
    ::testing::Test::RecordProperty("passed", passed);
    ::testing::Test::RecordProperty("wrong", wrong);
  }
};

/// Random segments until `passes` of them have passed; those are looked at densely.
Tally try_segments(const robot::RobotModel& robot, const robot::Scene& scene, const robot::MotionBound& bound,
                   int passes, const std::function<Motion()>& next, double spacing = kDense) {
  const robot::CollisionChecker checker(robot, scene);
  Bodies bodies(robot, scene);
  Tally tally;
  while (tally.passed < passes && tally.segments < 100 * passes) {
    const Motion motion = next();
    ++tally.segments;
    if (!prove(robot, bound, bodies, motion).passed) continue;
    ++tally.passed;
    const auto collision = first_collision(checker, robot, motion, spacing);
    if (!collision && checker.free(motion.from)) continue;
    ++tally.wrong;
    std::ostringstream text;
    text << "in collision at " << collision.value_or(0.0) << ": " << motion.from.transpose() << " to "
         << motion.to.transpose();
    tally.example = text.str();
  }
  tally.record();
  return tally;
}

/// The shelf scene's start by the names of another robot's joints in the same order.
VectorXd start_of(const robot::Scene& scene, const robot::RobotModel& robot) {
  EXPECT_EQ(scene.start.size(), robot.dof());
  return robot.clip(scene.start);
}

TEST(PathProof, NeverPassesWhatDenseSamplesFindOurs) {
  const robot::RobotModel robot(robot::load_robot(kModels + "ur5_allegro/ur5_allegro_right.yaml"));
  const robot::Scene scene = robot::load_scene(kModels + "scenes/bottle_shelf.yaml");
  Rng rng = stream(11, "test/path_proof/ours");
  const VectorXd about = start_of(scene, robot);
  const auto tally =
      try_segments(robot, scene, robot::MotionBound(robot), count_from_environment("OPPONENS_PROOF_SEGMENTS", 60),
                   [&] { return random_motion(robot, about, rng); });
  EXPECT_EQ(tally.wrong, 0) << tally.example;
  EXPECT_LT(tally.passed, tally.segments);
}

TEST(PathProof, NeverPassesWhatDenseSamplesFindLaboratory) {
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no shared data";
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const robot::RobotModel robot(
      robot::load_robot(OPPONENS_SOURCE_DIR "/tests/data/robots/paper_lab_ur5_allegro_right_visual.yaml"));
  const robot::Scene scene = robot::load_scene(kModels + "scenes/bottle_shelf.yaml");
  Rng rng = stream(12, "test/path_proof/laboratory");
  VectorXd about = start_of(scene, robot);
  about[0] -= 0.25 * M_PI;  // its shoulder pan is zero 45 degrees away from ours
  const auto tally =
      try_segments(robot, scene, robot::MotionBound(robot), count_from_environment("OPPONENS_PROOF_SEGMENTS", 20),
                   [&] { return random_motion(robot, about, rng); });
  EXPECT_EQ(tally.wrong, 0) << tally.example;
  EXPECT_LT(tally.passed, tally.segments);
}

/// A ball among thin plates: many motions pass a plate, and its bound is tight, so half of it shows.
class Plates : public ::testing::Test {
 protected:
  Plates() {
    Rng rng = stream(13, "test/path_proof/plates");
    for (int i = 0; i < 6; ++i) {
      scene.bodies.push_back(body("plate" + std::to_string(i), robot::Box{Eigen::Vector3d(0.001, 0.2, 0.2)},
                                  {rng.uniform(-1, 1), rng.uniform(-1, 1), 0}));
    }
  }
  Tally run(double factor, int passes, double spacing) {
    Rng rng = stream(14, "test/path_proof/plates/motions");
    const auto next = [&] { return Motion{random_configuration(robot, rng), random_configuration(robot, rng)}; };
    return try_segments(robot, scene, robot::MotionBound(robot, factor), passes, next, spacing);
  }
  robot::RobotModel robot = gantry();
  robot::Scene scene;
};

TEST_F(Plates, NoneIsPassedThrough) {
  const auto tally = run(1.0, 40, kDense);
  EXPECT_EQ(tally.wrong, 0) << tally.example;
}

TEST_F(Plates, HalfTheBoundIsCaught) {
  const auto tally = run(0.5, 150, 1e-3);
  EXPECT_GT(tally.wrong, 0);
}

TEST(PathProof, WorstClearanceIsThatOfDenseSamples) {
  const robot::RobotModel robot(robot::load_robot(kModels + "ur5_allegro/ur5_allegro_right.yaml"));
  const robot::Scene scene = robot::load_scene(kModels + "scenes/bottle_shelf.yaml");
  const robot::CollisionChecker checker(robot, scene);
  const robot::MotionBound bound(robot);
  Bodies bodies(robot, scene);
  Rng rng = stream(15, "test/path_proof/clearance");
  const VectorXd about = start_of(scene, robot);
  ProofSettings settings;
  settings.clearance = 1e-4;
  int compared = 0;
  while (compared < 25) {
    Motion motion = random_motion(robot, about, rng);
    motion.to = motion.from + (motion.to - motion.from) * (0.02 / (motion.to - motion.from).norm());
    const Proven proven = prove(robot, bound, bodies, motion, settings);
    if (!proven.passed) continue;
    ++compared;
    double dense = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 200;  // 1e-4 rad
    for (int k = 0; k <= kSteps; ++k) {
      dense = std::min(dense, checker.clearance(motion.from + (motion.to - motion.from) * k / kSteps).distance);
    }
    EXPECT_LE(proven.proven, dense);
    EXPECT_GE(proven.proven, 0.9 * proven.worst - 1e-12);
    EXPECT_GE(dense, 0.9 * proven.worst);
    EXPECT_LE(dense, proven.worst / 0.9 + kTriangulation);
  }
}

}  // namespace
}  // namespace opponens::verify
