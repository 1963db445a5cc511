// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What the proof is for: it catches what samples step over, and never passes what dense samples find in collision.
#include "verify/path_proof.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <string>

#include "core/rng.hpp"
#include "motion/edge_check.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "tests/verify/gantry.hpp"

namespace opponens::verify {
namespace {

using Eigen::VectorXd;

const std::string kModels = OPPONENS_SOURCE_DIR "/models/";
constexpr double kDense = 1e-4;            // rad
constexpr double kTriangulation = 4.1e-5;  // m, of two round shapes

struct Motion {
  VectorXd from;
  VectorXd to;
};

struct Proven {
  bool passed;
  double worst;
  double proven;
};

/// One segment by itself.
Proven prove(const robot::RobotModel& robot, const robot::MotionBound& bound, Bodies& bodies, const Motion& motion,
             const ProofSettings& settings = {}) {
  PathProof proof(robot, bound, bodies, {}, settings);
  proof.visit(motion.from, 0, false, true);
  proof.visit(motion.to, 1, false, false);
  proof.prove(motion.from, motion.to, 1, false);
  Proven result{true, std::numeric_limits<double>::infinity(), proof.proven_clearance()};
  for (const auto& [pair, found] : proof.found()) {
    result.worst = std::min(result.worst, found.distance);
    if (found.distance < settings.clearance || !found.proven) result.passed = false;
  }
  return result;
}

/// Fraction of a collision on the segment among samples at most `spacing` apart, in bisection order.
std::optional<double> first_collision(const robot::CollisionChecker& checker, const robot::RobotModel& robot,
                                      const Motion& motion, double spacing) {
  std::int64_t checks = 0;
  return motion::first_invalid(
      motion.from, motion.to, [&](const VectorXd& q) { return checker.free(q); }, robot.weights(), spacing, checks);
}

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
  int wrong = 0;  ///< passed, but a dense sample is in collision
};

/// Random segments until `passes` of them have passed; those are looked at densely.
Tally try_segments(const robot::RobotModel& robot, const robot::Scene& scene, const robot::MotionBound& bound,
                   int passes, const std::function<Motion()>& next) {
  const robot::CollisionChecker checker(robot, scene);
  Bodies bodies(robot, scene);
  Tally tally;
  while (tally.passed < passes && tally.segments < 100 * passes) {
    const Motion motion = next();
    ++tally.segments;
    if (!prove(robot, bound, bodies, motion).passed) continue;
    ++tally.passed;
    const auto collision = first_collision(checker, robot, motion, kDense);
    if (!collision && checker.free(motion.from)) continue;
    ++tally.wrong;
    std::cout << "  passed, but in collision at " << collision.value_or(0.0) << ": " << motion.from.transpose()
              << " to " << motion.to.transpose() << "\n";
  }
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
  std::cout << tally.segments << " segments, " << tally.passed << " passed\n";
  EXPECT_EQ(tally.wrong, 0);
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
  std::cout << tally.segments << " segments, " << tally.passed << " passed\n";
  EXPECT_EQ(tally.wrong, 0);
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
  Tally run(double factor, int passes) {
    Rng rng = stream(14, "test/path_proof/plates/motions");
    return try_segments(robot, scene, robot::MotionBound(robot, factor), passes, [&] {
      return Motion{random_configuration(robot, rng), random_configuration(robot, rng)};
    });
  }
  robot::RobotModel robot = gantry();
  robot::Scene scene;
};

TEST_F(Plates, NoneIsPassedThrough) {
  const auto tally = run(1.0, 100);
  std::cout << tally.segments << " segments, " << tally.passed << " passed\n";
  EXPECT_EQ(tally.wrong, 0);
}

TEST_F(Plates, HalfTheBoundIsCaught) {
  const auto tally = run(0.5, 150);
  std::cout << tally.segments << " segments, " << tally.passed << " passed, " << tally.wrong << " wrongly\n";
  EXPECT_GT(tally.wrong, 0);
}

/// The lowest surface point of the hand at q, m, in the world.
Eigen::Vector3d lowest_point(const robot::RobotModel& robot, const robot::Scene& scene, const VectorXd& q) {
  const auto X_RL = robot.link_poses(q);
  Eigen::Vector3d lowest = Eigen::Vector3d::Constant(1e9);
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    for (const auto& g : robot.links()[l].collision) {
      const Eigen::Isometry3d X = scene.X_WR * X_RL[l] * g.X_BG;
      const auto mesh = robot::triangulate(g.shape, 256);
      for (const auto& v : mesh.vertices.colwise()) {
        const Eigen::Vector3d p = X * Eigen::Vector3d(v);
        if (p.z() < lowest.z()) lowest = p;
      }
    }
  }
  return lowest;
}

/// A plate of 1 mm stands under the middle of a motion of the whole arm and reaches `into` m into the way of the hand's
/// lowest point: where the planner's samples are, nothing touches it.
TEST(PathProof, CatchesThePlateThatThePlannersResolutionStepsOver) {
  const robot::RobotModel robot(robot::load_robot(kModels + "ur5_allegro/ur5_allegro_right.yaml"));
  robot::Scene scene;
  scene.X_WR.translation().z() = 1.0;
  // The arm stretched out to the front, its hand hanging down at its end.
  Motion motion{VectorXd::Zero(robot.dof()), {}};
  motion.from.head<6>() << -0.4, -0.3, 0.4, -1.7, -1.5708, 0.0;
  motion.to = motion.from;
  motion.to[0] = 0.4;
  for (const auto& [resolution, into] : {std::pair(0.02, 4e-4), std::pair(0.002, 3e-6)}) {
    // Between two samples; 0.8 rad are divided into equal parts of at most the resolution.
    const double parts = std::ceil(0.8 / resolution);
    const double fraction = (std::floor(0.5 * parts) + 0.5) / parts;
    const VectorXd q = motion.from + fraction * (motion.to - motion.from);
    const Eigen::Vector3d p = lowest_point(robot, scene, q);
    scene.bodies = {
        body("plate", robot::Box{Eigen::Vector3d(0.001, 0.1, 0.1)}, p - Eigen::Vector3d(0, 0, 0.05 - into))};
    scene.bodies[0].X_WB.linear() =
        Eigen::AngleAxisd(std::atan2(p.y(), p.x()) + 0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const robot::CollisionChecker checker(robot, scene);
    ASSERT_FALSE(checker.free(q));
    EXPECT_FALSE(first_collision(checker, robot, motion, resolution)) << "the samples at " << resolution << " meet it";
    EXPECT_TRUE(first_collision(checker, robot, motion, resolution / 200)) << "dense ones do not";
    Bodies bodies(robot, scene);
    const Proven proven = prove(robot, robot::MotionBound(robot), bodies, motion);
    EXPECT_FALSE(proven.passed);
    EXPECT_EQ(proven.worst, 0.0);
    EXPECT_EQ(proven.proven, 0.0);
  }
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

TEST(PathProof, TheWholePathOfTheHandInABottleFails) {
  // A ball in the middle of a closed hall whose walls it never meets.
  const robot::RobotModel robot = gantry();
  robot::Scene scene;
  const auto hall =
      std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Eigen::Vector3d(5, 5, 5)}));
  scene.bodies = {body("hall", hall, {0, 0, 0})};
  Bodies bodies(robot, scene);
  const Motion motion{Eigen::Vector3d(-0.5, 0, 0), Eigen::Vector3d(0.5, 0, 0)};
  const Proven proven = prove(robot, robot::MotionBound(robot), bodies, motion);
  EXPECT_FALSE(proven.passed);
  EXPECT_EQ(proven.worst, 0.0);
}

/// A finger that dips into its object between two waypoints at which it only touches it.
TEST(PathProof, AContactThatIsDeeperBetweenTheWaypoints) {
  robot::RobotDescription description = gantry().description();
  description.joints[2].type = robot::JointType::revolute;
  description.joints[2].axis = Eigen::Vector3d::UnitY();
  description.joints[2].X_PJ.translation().setZero();
  description.joints[2].lower = -3.0;
  description.joints[2].upper = 3.0;
  description.links[3].collision[0].X_BG.translation() = Eigen::Vector3d(0.1, 0, 0);
  const robot::RobotModel robot(description);
  // The finger's ball (10 mm) turns by 0.5 rad either way about the palm; its outermost point is 0.11 m away half way.
  const Motion motion{Eigen::Vector3d(0, 0, -0.5), Eigen::Vector3d(0, 0, 0.5)};
  const double at_ends = 0.1 * std::cos(0.5) + 0.01;
  const auto deepest = [&](double front) {
    robot::Scene scene;
    const auto cube =
        std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Eigen::Vector3d(0.2, 0.2, 0.2)}));
    scene.bodies = {body("cube", cube, {front + 0.1, 0, 0})};
    Bodies bodies(robot, scene);
    const robot::MotionBound bound(robot);
    PathProof proof(robot, bound, bodies, {{"finger", "cube"}}, {});
    proof.visit(motion.from, 0, false, true);
    proof.visit(motion.to, 1, true, false);
    proof.prove(motion.from, motion.to, 1, true);
    return proof.contacts().at({"finger", "cube"});
  };
  EXPECT_GT(0.11 - at_ends, 0.01);
  const auto deep = deepest(0.11 - 0.0015);
  EXPECT_GT(deep.attained, 0.001);
  EXPECT_NEAR(deep.place.fraction, 0.5, 0.15);  // where it is 1 mm deep or more
  const auto shallow = deepest(0.11 - 0.0006);
  EXPECT_NEAR(shallow.attained, 0.0006, 1e-4);
  EXPECT_GE(shallow.proven, 0.0006);
  EXPECT_LE(shallow.proven, 0.001);
}

}  // namespace
}  // namespace opponens::verify
