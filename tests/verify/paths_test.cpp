// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"
#include "tests/verify/gantry.hpp"
#include "verify/collision_bodies.hpp"

namespace opponens::verify {
namespace {

class CheckPath : public ::testing::Test {
 protected:
  CheckPath() {
    scene.bodies.push_back(body("wall", robot::Box{Eigen::Vector3d(0.002, 0.4, 1.0)}, {0, 0.3, 0}));
    path.joint_names = robot.joint_names();
    path.waypoints.resize(3, 3);
    path.waypoints << -0.5, 0.0, 0, 0.0, -0.2, 0, 0.5, 0.0, 0;  // around the wall's end at y = 0.1
    claim.start = path.waypoints.row(0).transpose();
    claim.goal = path.waypoints.row(2).transpose();
  }
  Verdict check() const { return check_path(path, claim, robot, scene); }
  bool fault_is(const std::string& part) const {
    for (const std::string& reason : check().reasons) {
      if (reason.find(part) != std::string::npos) return true;
    }
    for (const std::string& reason : check().reasons) ADD_FAILURE() << "got: " << reason;
    return false;
  }
  robot::RobotModel robot = gantry();
  robot::Scene scene;
  JointPath path;
  PathClaim claim;
};

TEST_F(CheckPath, ARightOnePassesWithItsClearance) {
  const Verdict verdict = check();
  EXPECT_TRUE(verdict.ok);
  EXPECT_EQ(verdict.reasons.size(), 0U);
  // From the wall's corner (-0.001, 0.1) to the palm's line through (-0.5, 0) and (0, -0.2), less its radius; sampling
  // every 0.02 along it misses at most 0.01^2 / (2 * 0.278), and the polyhedron of a ball 0.0012 of its radius.
  const double exact = (0.499 * 0.2 + 0.1 * 0.5) / std::hypot(0.5, 0.2) - 0.05;
  EXPECT_GE(verdict.worst_clearance, exact - 1e-9);
  EXPECT_LE(verdict.worst_clearance, exact + 2.4e-4);
  EXPECT_GT(verdict.checked, 500);
  EXPECT_EQ(verdict.worst_contact_penetration, 0.0);
}

TEST_F(CheckPath, ThroughAThinWallBetweenTheWaypoints) {
  path.waypoints.row(1) << 0.3, 0.18, 0;
  const Verdict verdict = check();
  EXPECT_FALSE(verdict.ok);
  EXPECT_TRUE(fault_is("collision of palm and wall between waypoints 0 and 1"));
  EXPECT_EQ(verdict.worst_clearance, 0.0);
  EXPECT_LE(verdict.reasons.size(), 10U);
}

TEST_F(CheckPath, LimitsEndsAndForm) {
  path.waypoints(1, 2) = 1.5;
  EXPECT_TRUE(fault_is("waypoint 1: joint f = 1.5 rad is outside [-1, 1]"));
  path.waypoints(1, 2) = 0.0;
  claim.start[1] += 1e-6;
  EXPECT_TRUE(fault_is("waypoint 0 differs from the start by 1e-06 rad"));
  claim.start[1] -= 1e-6;
  claim.goal[0] = 0.4;
  EXPECT_TRUE(fault_is("waypoint 2 differs from the pre-grasp by 0.1 rad"));
  claim.goal[0] = 0.5;
  std::swap(path.joint_names[0], path.joint_names[1]);
  EXPECT_TRUE(fault_is("joints are not the robot's"));
  std::swap(path.joint_names[0], path.joint_names[1]);
  path.waypoints(1, 0) = NAN;
  EXPECT_TRUE(fault_is("finite"));
}

TEST_F(CheckPath, ThePalmMustBeWhereTheGraspSays) {
  // Start, pre-grasp and grasp agree with the joint values that the claim names; only the poses tell.
  claim.grasp = claim.goal;
  claim.closing_from = 2;
  claim.X_WH_pregrasp = Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.0, 0.0));
  claim.X_WH_grasp = claim.X_WH_pregrasp;
  EXPECT_TRUE(check().ok);
  claim.X_WH_pregrasp->translation().y() = 2e-6;
  EXPECT_TRUE(fault_is("the path's pre-grasp puts the palm 0.002 mm and 0 rad off the grasp's pose"));
  claim.X_WH_pregrasp->translation().y() = 0.0;
  claim.X_WH_grasp->linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(fault_is("the path's end puts the palm 0 mm and 0.1 rad off the grasp's pose"));
  // The robot stands somewhere else: so does the palm.
  claim.X_WH_grasp->linear().setIdentity();
  scene.X_WR.translation().z() = 0.01;
  EXPECT_TRUE(fault_is("the path's end puts the palm 10 mm"));
}

TEST_F(CheckPath, LooksBetweenTheFractionsOfAPlannersOwnCheck) {
  // A film so thin that the palm hits it only within 0.0003 of the middle between two samples of 0.002: the ends of the
  // equal parts are free, their middles are not.
  path.waypoints.resize(2, 3);
  path.waypoints << 0.0, 0.0, 0, 0.2, 0.0, 0;
  claim.start = path.waypoints.row(0).transpose();
  claim.goal = path.waypoints.row(1).transpose();
  const double height = std::sqrt(0.05 * 0.05 - 0.0003 * 0.0003);  // of the film's edge above the ball's way
  scene.bodies = {body("film", robot::Box{Eigen::Vector3d(1e-6, 0.2, 0.01)}, {0.101, 0.1 + height, 0})};
  EXPECT_TRUE(fault_is("collision of palm and film between waypoints 0 and 1 at 0.505"));
  const Verdict verdict = check();
  EXPECT_EQ(verdict.worst_pair.first, "palm");
  EXPECT_EQ(verdict.worst_pair.second, "film");
}

TEST_F(CheckPath, BallWhollyInsideAMeshIsACollision) {
  const auto mesh =
      std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Eigen::Vector3d(3, 3, 3)}));
  scene.bodies = {body("hall", mesh, {0, 0, 0})};
  EXPECT_TRUE(fault_is("collision of palm and hall at waypoint 0"));
}

TEST_F(CheckPath, ClosingSegmentMayTouchItsContactsAlone) {
  // A cube before the finger: at x = 0.5 the finger's ball (radius 10 mm, at x + 0.1) ends 0.5 mm inside it.
  const auto cube =
      std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Eigen::Vector3d(0.1, 0.1, 0.1)}));
  scene.bodies.push_back(body("cube", cube, {0.6595, 0, 0}));
  path.waypoints.row(2) << 0.45, 0.0, 0;
  path.waypoints.conservativeResize(4, 3);
  path.waypoints.row(3) << 0.5, 0.0, 0;
  claim.goal = path.waypoints.row(2).transpose();
  claim.grasp = path.waypoints.row(3).transpose();
  claim.closing_from = 2;
  claim.object = "cube";
  EXPECT_TRUE(fault_is("collision of finger and cube"));  // no contact is stored for the finger
  claim.contact_links = {"finger"};
  Verdict verdict = check();
  EXPECT_TRUE(verdict.ok) << verdict.reasons.front();
  EXPECT_NEAR(verdict.worst_contact_penetration, 0.0005, 0.0001);
  EXPECT_GT(verdict.worst_clearance, 0.0);
  scene.bodies.back().X_WB.translation().x() -= 0.002;
  EXPECT_TRUE(fault_is("contact of finger and cube is 2."));
  EXPECT_NEAR(check().worst_contact_penetration, 0.0025, 0.0001);
  claim.grasp = Eigen::Vector3d(0.49, 0, 0);
  EXPECT_TRUE(fault_is("waypoint 3 differs from the grasp"));
  claim.closing_from = 7;
  EXPECT_TRUE(fault_is("the closing segment begins at waypoint 7 of 4"));
}

TEST(CollisionBodies, AgreesWithTheChecker) {
  const std::filesystem::path models = std::filesystem::path(OPPONENS_SOURCE_DIR) / "models";
  const robot::RobotModel robot(robot::load_robot(models / "ur5_allegro" / "ur5_allegro_right.yaml"));
  const robot::Scene scene = robot::load_scene(models / "scenes" / "bottle_shelf.yaml");
  const robot::CollisionChecker checker(robot, scene);
  CollisionBodies bodies(robot, scene);
  Rng rng = stream(4, "test/agree");
  int free = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    Eigen::VectorXd q(robot.dof());
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng.uniform(robot.lower()[j], robot.upper()[j]);
    bodies.set(q);
    std::set<CollisionBodies::Pair> sorted;
    for (auto [a, b] : bodies.colliding()) {
      const bool self =
          std::any_of(robot.links().begin(), robot.links().end(), [&](const auto& l) { return l.name == b; });
      sorted.emplace(self ? std::min(a, b) : a, self ? std::max(a, b) : b);
    }
    const std::vector<robot::BodyPair> expected = checker.colliding_pairs(q);
    ASSERT_EQ(sorted, std::set<CollisionBodies::Pair>(expected.begin(), expected.end())) << "q = " << q.transpose();
    if (sorted.empty()) {
      ++free;
      // The widest link's radius is 75 mm; two such polyhedra are 0.18 mm too thin.
      ASSERT_NEAR(bodies.clearance({}, 10.0).distance, checker.clearance(q).distance, 1.8e-4)
          << "q = " << q.transpose();
    }
  }
  EXPECT_GT(free, 50);
  EXPECT_LT(free, 1400);
}

}  // namespace
}  // namespace opponens::verify
