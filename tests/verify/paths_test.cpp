// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "robot/mesh.hpp"
#include "tests/verify/gantry.hpp"

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
    claim.hands.resize(1);
  }
  Verdict check() {
    if (!checker) checker = std::make_unique<PathChecker>(robot, scene);
    return checker->check(path, claim, settings);
  }
  bool fault_is(const std::string& part) {
    const Verdict verdict = check();
    for (const std::string& reason : verdict.reasons) {
      if (reason.find(part) != std::string::npos) return true;
    }
    for (const std::string& reason : verdict.reasons) ADD_FAILURE() << "got: " << reason;
    return false;
  }
  robot::RobotModel robot = gantry();
  robot::Scene scene;
  JointPath path;
  PathClaim claim;
  PathCheckSettings settings;
  std::unique_ptr<PathChecker> checker;  ///< of the scene at the first check; reset when the scene changes later
};

TEST_F(CheckPath, ARightOnePassesWithItsClearance) {
  const Verdict verdict = check();
  EXPECT_TRUE(verdict.ok);
  EXPECT_EQ(verdict.reasons.size(), 0U);
  // From the wall's corner (-0.001, 0.1) to the palm's line through (-0.5, 0) and (0, -0.2), less its radius; the
  // polyhedron around the ball is 0.02 mm larger at most.
  const double exact = (0.499 * 0.2 + 0.1 * 0.5) / std::hypot(0.5, 0.2) - 0.05;
  EXPECT_GE(verdict.worst_clearance, exact - 2e-5);
  EXPECT_LE(verdict.worst_clearance, exact / 0.9);
  EXPECT_GE(verdict.proven_clearance, 0.9 * verdict.worst_clearance);
  EXPECT_LE(verdict.proven_clearance, exact);
  EXPECT_EQ(verdict.worst_pair, std::pair(std::string("palm"), std::string("wall")));
  EXPECT_NE(verdict.worst_place.find("between waypoints "), std::string::npos) << verdict.worst_place;
  EXPECT_GT(verdict.checked, 5);
  EXPECT_EQ(verdict.worst_contact_penetration, 0.0);
}

TEST_F(CheckPath, TheClearanceIsKeptOrTheReasonTold) {
  // Along the wall, which ends at y = 0.1, at 0.4 mm from it all the way.
  scene.bodies = {body("wall", robot::Box{Eigen::Vector3d(2.0, 0.1, 1.0)}, {0, 0.15 + 0.0504, 0})};
  path.waypoints.resize(2, 3);
  path.waypoints << -0.01, 0.1, 0, 0.01, 0.1, 0;
  claim.start = path.waypoints.row(0).transpose();
  claim.goal = path.waypoints.row(1).transpose();
  EXPECT_TRUE(fault_is("palm and wall are 0."));
  EXPECT_TRUE(fault_is(" apart "));
  EXPECT_TRUE(fault_is("less than 0.5 mm"));
  settings.proof.clearance = 0.00035;
  const Verdict verdict = check();
  EXPECT_TRUE(verdict.ok);
  EXPECT_NEAR(verdict.worst_clearance, 0.0004, 2.1e-5);
  EXPECT_GE(verdict.proven_clearance, 0.00035);
}

TEST_F(CheckPath, WhatCannotBeProvenFails) {
  // A path that turns back at exactly the clearance. Sliding along the wall too makes its bound larger than the way
  // towards the wall, so no piece around that end can be proven to keep the clearance.
  scene.bodies = {body("wall", robot::Box{Eigen::Vector3d(1.0, 0.1, 1.0)}, {0, 0.05 + 0.05 + 0.0005 + 2e-5, 0})};
  path.waypoints << -0.2, -0.5, 0, 0, 0, 0, -0.2, -0.5, 0;
  claim.goal = path.waypoints.row(2).transpose();
  claim.start = claim.goal;
  const double gap = check().worst_clearance;
  settings.proof.clearance = gap;
  const Verdict verdict = check();
  EXPECT_EQ(verdict.worst_clearance, gap);
  EXPECT_LT(verdict.proven_clearance, gap);
  EXPECT_GT(verdict.proven_clearance, gap - 3e-6);
  EXPECT_TRUE(fault_is("cannot be proven around there"));
}

TEST_F(CheckPath, ThroughAThinWallBetweenTheWaypoints) {
  path.waypoints.row(1) << 0.3, 0.18, 0;
  const Verdict verdict = check();
  EXPECT_FALSE(verdict.ok);
  EXPECT_TRUE(fault_is("collision of palm and wall between waypoints 0 and 1"));
  EXPECT_EQ(verdict.worst_clearance, 0.0);
  EXPECT_EQ(verdict.proven_clearance, 0.0);
  EXPECT_EQ(verdict.reasons.size(), 2U);  // one a pair: the finger passes through it too
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
  claim.hands[0].X_WH_pregrasp = Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.0, 0.0));
  claim.hands[0].X_WH_grasp = claim.hands[0].X_WH_pregrasp;
  EXPECT_TRUE(check().ok);
  claim.hands[0].X_WH_pregrasp->translation().y() = 2e-6;
  EXPECT_TRUE(fault_is("the path's pre-grasp puts the palm 0.002 mm and 0 rad off the grasp's pose"));
  claim.hands[0].X_WH_pregrasp->translation().y() = 0.0;
  claim.hands[0].X_WH_grasp->linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(fault_is("the path's end puts the palm 0 mm and 0.1 rad off the grasp's pose"));
  // The robot stands somewhere else: so does the palm.
  claim.hands[0].X_WH_grasp->linear().setIdentity();
  scene.X_WR.translation().z() = 0.01;
  checker.reset();
  EXPECT_TRUE(fault_is("the path's end puts the palm 10 mm"));
}

TEST_F(CheckPath, AFilmOfAMicrometreIsMet) {
  // The palm hits it only within 0.0003 of the middle between two samples of 0.002.
  path.waypoints.resize(2, 3);
  path.waypoints << 0.0, 0.0, 0, 0.2, 0.0, 0;
  claim.start = path.waypoints.row(0).transpose();
  claim.goal = path.waypoints.row(1).transpose();
  const double height = std::sqrt(0.05 * 0.05 - 0.0003 * 0.0003);  // of the film's edge above the ball's way
  scene.bodies = {body("film", robot::Box{Eigen::Vector3d(1e-6, 0.2, 0.01)}, {0.101, 0.1 + height, 0})};
  EXPECT_TRUE(fault_is("collision of palm and film between waypoints 0 and 1 at 0.50"));
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
  claim.hands[0].object = "cube";
  EXPECT_TRUE(fault_is("collision of finger and cube"));  // no contact is stored for the finger
  claim.hands[0].contact_links = {"finger"};
  Verdict verdict = check();
  EXPECT_TRUE(verdict.ok) << verdict.reasons.front();
  EXPECT_NEAR(verdict.worst_contact_penetration, 0.0005, 0.0001);
  EXPECT_GT(verdict.worst_clearance, 0.0);
  scene.bodies.back().X_WB.translation().x() -= 0.002;
  checker.reset();
  EXPECT_TRUE(fault_is("contact of finger and cube is 2."));
  EXPECT_NEAR(check().worst_contact_penetration, 0.0025, 0.0001);
  claim.grasp = Eigen::Vector3d(0.49, 0, 0);
  EXPECT_TRUE(fault_is("waypoint 3 differs from the grasp"));
  claim.closing_from = 7;
  EXPECT_TRUE(fault_is("the closing segment begins at waypoint 7 of 4"));
}

/// Each finger of two hands pressed 0.5 mm into a cube of its own.
class CheckPathOfTwoHands : public ::testing::Test {
 protected:
  CheckPathOfTwoHands() {
    const auto cube =
        std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Eigen::Vector3d(0.1, 0.1, 0.1)}));
    scene.bodies = {body("right_cube", cube, {0.6595, -0.5, 0}), body("left_cube", cube, {0.6595, 0.5, 0})};
    path.joint_names = robot.joint_names();
    path.waypoints.resize(3, 6);
    path.waypoints << 0, 0, 0, 0, 0, 0, 0.45, 0, 0.45, 0, 0, 0, 0.5, 0, 0.5, 0, 0, 0;
    claim.start = path.waypoints.row(0).transpose();
    claim.goal = path.waypoints.row(1).transpose();
    claim.grasp = path.waypoints.row(2).transpose();
    claim.closing_from = 1;
    for (const auto& [arm, y] : {std::pair{std::string("right"), -0.5}, {std::string("left"), 0.5}}) {
      claim.hands.push_back({Eigen::Isometry3d(Eigen::Translation3d(0.45, y, 0)),
                             Eigen::Isometry3d(Eigen::Translation3d(0.5, y, 0)),
                             arm + "_cube",
                             {arm + "/finger"}});
    }
  }
  Verdict check() { return PathChecker(robot, scene).check(path, claim); }
  void expect_fault(const std::string& part) {
    const Verdict verdict = check();
    EXPECT_FALSE(verdict.ok) << "not seen: " << part;
    std::string all;
    for (const std::string& reason : verdict.reasons) all += reason + "; ";
    EXPECT_NE(all.find(part), std::string::npos) << all;
  }
  robot::RobotModel robot = two_gantries();
  robot::Scene scene;
  JointPath path;
  PathClaim claim;
};

TEST_F(CheckPathOfTwoHands, EachMayTouchItsOwnObject) {
  const Verdict verdict = check();
  EXPECT_TRUE(verdict.ok) << verdict.reasons.front();
  EXPECT_NEAR(verdict.worst_contact_penetration, 0.0005, 0.0001);
}

TEST_F(CheckPathOfTwoHands, NeitherMayTouchTheOthersObject) {
  // The left hand's cube is claimed to be the right one's: now both fingers are in collision.
  std::swap(claim.hands[0].object, claim.hands[1].object);
  expect_fault("collision of left/finger and left_cube");
  expect_fault("collision of right/finger and right_cube");
}

TEST_F(CheckPathOfTwoHands, AContactIsOfTheHandThatClaimsIt) {
  // That the right hand's grasp has a contact by the left finger does not let that one touch the right hand's object.
  claim.hands[0].contact_links.insert("left/finger");
  expect_fault("a contact with right_cube is by left/finger, which is no link of that hand");
  claim.hands[0].contact_links = {"no such link"};
  expect_fault("by no such link, which is no link of that hand");
  claim.hands[0].contact_links.clear();
  expect_fault("collision of right/finger and right_cube");
}

TEST_F(CheckPathOfTwoHands, BothPalmsMustBeWhereTheirGraspsSay) {
  claim.hands[1].X_WH_pregrasp->translation().z() = 1e-3;
  expect_fault("the path's pre-grasp of arm left puts the palm 1 mm");
  claim.hands[1].X_WH_pregrasp->translation().z() = 0.0;
  std::swap(claim.hands[0].X_WH_grasp, claim.hands[1].X_WH_grasp);
  expect_fault("the path's end of arm right puts the palm 1000 mm");
  expect_fault("the path's end of arm left puts the palm 1000 mm");
}

TEST_F(CheckPathOfTwoHands, AClaimForOneHandAloneIsRefused) {
  claim.hands.pop_back();
  EXPECT_THROW(check(), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::verify
