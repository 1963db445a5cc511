// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot/convex_distance.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "tests/verify/gantry.hpp"

namespace opponens::verify {
namespace {

using NamePair = std::pair<std::string, std::string>;

Eigen::VectorXd random_configuration(const robot::RobotModel& robot, Rng& rng) {
  Eigen::VectorXd q(robot.dof());
  for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng.uniform(robot.lower()[j], robot.upper()[j]);
  return q;
}

struct Answer {
  std::set<NamePair> colliding;  ///< link names of a pair in the order of the alphabet
  double clearance = 0.5;
};

Answer answer_of(const Bodies& bodies) {
  Answer answer;
  for (const auto& pair : bodies.pairs()) {
    // Far pairs would cost most and decide nothing.
    const double bound = std::max(0.02, answer.clearance);
    const double gap = bodies.gap(pair, bound);
    if (gap >= bound) continue;
    const double distance = bodies.distance(pair, bound);
    EXPECT_LE(gap, distance + 1e-9) << bodies.name(pair.first) << " " << bodies.name(pair.second);
    answer.clearance = std::min(answer.clearance, distance);
    if (distance > 0.0 && !(gap == 0.0 && bodies.contained(pair))) continue;
    NamePair names{bodies.name(pair.first), bodies.name(pair.second)};
    if (bodies.link(pair.second) >= 0 && names.second < names.first) std::swap(names.first, names.second);
    answer.colliding.insert(names);
  }
  return answer;
}

TEST(Bodies, AgreeWithTheChecker) {
  const robot::RobotModel robot(robot::load_robot(OPPONENS_SOURCE_DIR "/models/ur5_allegro/ur5_allegro_right.yaml"));
  const robot::Scene scene = robot::load_scene(OPPONENS_SOURCE_DIR "/models/scenes/bottle_shelf.yaml");
  const robot::CollisionChecker checker(robot, scene);
  Bodies bodies(robot, scene);
  Rng rng = stream(4, "test/agree");
  int free = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const Eigen::VectorXd q = random_configuration(robot, rng);
    bodies.place(robot.link_poses(q));
    const Answer answer = answer_of(bodies);
    const auto expected = checker.colliding_pairs(q);
    // Bodies contain the shapes: every collision is one here; what more there is lies within their tolerance.
    for (const auto& pair : expected) ASSERT_EQ(answer.colliding.count(pair), 1U) << pair.first << " " << pair.second;
    if (answer.colliding.size() > expected.size()) {
      ASSERT_TRUE(expected.empty()) << "not decidable by the least clearance alone; change the seed of this trial";
      ASSERT_LE(checker.clearance(q).distance, 4.1e-5);
      continue;
    }
    if (!expected.empty()) continue;
    ++free;
    const double exact = checker.clearance(q).distance;
    ASSERT_LE(answer.clearance, exact + 1e-7) << "q = " << q.transpose();
    ASSERT_GE(answer.clearance, exact - 4.1e-5) << "q = " << q.transpose();
  }
  EXPECT_GT(free, 5);
  EXPECT_LT(free, 145);
}

/// Between two meshes robot::CollisionChecker asks fcl::distance too; the oracle here is every pair of triangles.
TEST(Bodies, MeshDistanceIsThatOfAllTriangles) {
  Rng rng = stream(6, "test/bodies/meshes");
  robot::TriangleMesh flat = robot::triangulate(robot::Sphere{0.05}, 10);
  flat.triangles.conservativeResize(3, flat.triangles.cols() + 1);
  flat.triangles.rightCols<1>() << 0, 1, 0;  // a triangle without area
  const auto mesh = std::make_shared<const robot::TriangleMesh>(flat);
  robot::RobotDescription description = gantry().description();
  description.links[2].collision[0].shape = mesh;
  const robot::RobotModel robot(description);
  for (int trial = 0; trial < 40; ++trial) {
    robot::Scene scene;
    scene.bodies = {body("other", mesh, {0.3, 0, 0})};
    scene.bodies[0].X_WB.linear() =
        Eigen::AngleAxisd(rng.uniform(0, 3), Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized())
            .toRotationMatrix();
    Bodies bodies(robot, scene);
    const Eigen::Vector3d q(rng.uniform(0.0, 0.17), rng.uniform(-0.1, 0.1), 0.9);
    const auto X_RL = robot.link_poses(q);
    bodies.place(X_RL);
    double least = std::numeric_limits<double>::infinity();
    const Solid solid(mesh);
    for (int i = 0; i < static_cast<int>(flat.triangles.cols()); ++i) {
      const Eigen::Matrix3d a = (X_RL[2].linear() * solid.tree().corners(i)).colwise() + X_RL[2].translation();
      for (int j = 0; j < static_cast<int>(flat.triangles.cols()); ++j) {
        Eigen::Matrix3d b = scene.bodies[0].X_WB.linear() * solid.tree().corners(j);
        b.colwise() += scene.bodies[0].X_WB.translation();
        // Of two triangles that do not meet, a corner or an edge is nearest; edges by dense points are enough here.
        for (int k = 0; k < 3; ++k) {
          for (int step = 0; step <= 20; ++step) {
            const double u = step / 20.0;
            least = std::min(least, triangle_distance(b, (1 - u) * a.col(k) + u * a.col((k + 1) % 3)));
            least = std::min(least, triangle_distance(a, (1 - u) * b.col(k) + u * b.col((k + 1) % 3)));
          }
        }
      }
    }
    for (const auto& pair : bodies.pairs()) {
      if (bodies.name(pair.first) != "palm") continue;
      const double distance = bodies.distance(pair, 10.0);
      Bodies::NearPoints near = bodies.points(pair);
      EXPECT_GE(bodies.apart(pair, near), least - 1e-12);
      EXPECT_GE(bodies.approach(pair, 10.0), distance - 1e-12);
      EXPECT_LE(bodies.approach(pair, 10.0), distance + 0.062);  // a leaf spans two edges of 31 mm
      EXPECT_EQ(bodies.distance(pair, 10.0, near), distance);
      EXPECT_NEAR(bodies.apart(pair, near), distance, 1e-9);  // FCL's points are where it says
      EXPECT_NEAR(solid.distance(near.first), 0.0, 1e-9);
      EXPECT_NEAR(solid.distance(near.second), 0.0, 1e-9);
      const Bodies::NearPoints kept = near;
      EXPECT_EQ(bodies.distance(pair, 0.5 * distance, near), 0.5 * distance);
      EXPECT_EQ(near.first, kept.first);  // nothing nearer, nothing new
      ASSERT_LE(distance, least + 1e-12);
      ASSERT_GE(distance, least - 2e-5);  // a twentieth of an edge of 30 mm, 20 mm away or more
      EXPECT_EQ(bodies.distance(pair, 0.5 * least), 0.5 * least);
    }
  }
}

/// A ball of 50 mm whose centre stands at x from the origin, and another body there.
struct BallAgainst {
  BallAgainst(const robot::Shape& shape, double x) : scene(alone(shape)) {
    bodies.place(robot.link_poses(Eigen::Vector3d(x, 0, 0.9)));
    for (const auto& one : bodies.pairs()) {
      if (bodies.name(one.first) == "palm" && bodies.link(one.second) < 0) pair = one;
    }
  }
  static robot::Scene alone(const robot::Shape& shape) {
    robot::Scene made;
    made.bodies = {body("other", shape, {0, 0, 0})};
    return made;
  }
  double distance() const { return bodies.distance(pair, 10.0); }
  double depth() const { return bodies.depth(pair, 0.0).attained; }

  robot::RobotModel robot = gantry();
  robot::Scene scene;
  Bodies bodies{robot, scene};
  Bodies::Pair pair{};
};

TEST(Bodies, ABallIsItsCentreAndRadius) {
  const robot::Box box{Eigen::Vector3d(0.2, 0.4, 0.4)};
  EXPECT_NEAR(BallAgainst(box, 0.25).distance(), 0.1, 1e-12);
  EXPECT_NEAR(BallAgainst(robot::Sphere{0.1}, 0.25).distance(), 0.1, 1e-12);
  EXPECT_NEAR(BallAgainst(robot::Cylinder{0.1, 0.4}, 0.25).distance(), 0.1 - 1e-5, 1.1e-5);
  EXPECT_EQ(BallAgainst(box, 0.25).depth(), 0.0);
  const BallAgainst far(box, 0.25);
  for (int k = 1; k < 1000; ++k) {  // what is not nearer than the bound is told by the bound itself
    const double bound = 0.0999 * k / 1000.0;
    EXPECT_EQ(far.bodies.distance(far.pair, bound), bound);
  }
  EXPECT_EQ(BallAgainst(box, 0.149).distance(), 0.0);
  EXPECT_NEAR(BallAgainst(box, 0.149).depth(), 0.001, 1e-12);
  EXPECT_NEAR(BallAgainst(robot::Sphere{0.1}, 0.149).depth(), 0.001, 1e-12);
  EXPECT_NEAR(BallAgainst(box, 0.06).depth(), 0.09, 1e-4);  // its centre inside: 0.1 - 0.06 + 0.05, from all triangles
}

TEST(Bodies, ABallInAHallIsContained) {
  const BallAgainst hall(robot::Box{Eigen::Vector3d(3, 3, 3)}, 0.0);
  EXPECT_NEAR(hall.distance(), 1.45, 1e-12);
  EXPECT_TRUE(hall.bodies.contained(hall.pair));
  // A small body in the ball: there is no surface of the ball near, but nothing lets it pass.
  EXPECT_EQ(BallAgainst(robot::Box{Eigen::Vector3d(0.01, 0.01, 0.01)}, 0.0).distance(), 0.0);
  EXPECT_EQ(BallAgainst(robot::Sphere{0.01}, 0.0).distance(), 0.0);
  EXPECT_EQ(BallAgainst(robot::Sphere{0.2}, 0.0).distance(), 0.0);
}

}  // namespace
}  // namespace opponens::verify
