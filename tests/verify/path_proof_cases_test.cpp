// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Made cases of the proof: thin plates between samples, a hall without walls near by, a contact between waypoints.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "tests/verify/gantry.hpp"
#include "tests/verify/prove.hpp"

namespace opponens::verify {
namespace {

using Eigen::VectorXd;

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
  const robot::RobotModel robot(robot::load_robot(OPPONENS_SOURCE_DIR "/models/ur5_allegro/ur5_allegro_right.yaml"));
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
