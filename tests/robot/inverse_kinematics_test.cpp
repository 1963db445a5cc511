// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/inverse_kinematics.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

std::string our_robot() { return OPPONENS_SOURCE_DIR "/models/ur5_allegro/ur5_allegro_right.yaml"; }

Isometry3d palm_pose(const RobotModel& robot, const VectorXd& q_a) {
  VectorXd q = robot.clip(VectorXd::Zero(robot.dof()));
  q.head<6>() = q_a;
  return robot.link_poses(q)[static_cast<std::size_t>(robot.palm())];
}

/// A reachable position per kind: anywhere; or with elbow, wrist, or both within 0 .. 1e-3 of singular.
VectorXd position(const RobotModel& robot, int kind, Rng& rng) {
  VectorXd q(6);
  for (int i = 0; i < 6; ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
  const double near = rng.uniform() < 0.3 ? 0.0 : std::pow(10.0, -rng.uniform(3, 14));
  if (kind == 1) q[4] = near;
  if (kind == 2) q[2] = -near;
  if (kind == 3) q[4] = -kPi + near;
  if (kind == 4) q[2] = q[4] = near;
  return q;
}

double turns_apart(const VectorXd& a, const VectorXd& b) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * kPi)));
  return largest;
}

void check_round_trips(const RobotModel& robot) {
  const ArmKinematics arm(robot);
  Rng rng(11);
  for (int kind = 0; kind < 5; ++kind) {
    for (int sample = 0; sample < 400; ++sample) {
      const VectorXd wanted = position(robot, kind, rng);
      const Isometry3d X_RH = palm_pose(robot, wanted);
      const std::vector<VectorXd> solutions = arm.solve(X_RH);
      ASSERT_FALSE(solutions.empty()) << "kind " << kind << " q " << wanted.transpose();
      double nearest = 1e9;
      for (const VectorXd& q : solutions) {
        ASSERT_TRUE(q.allFinite());
        const double residual = (palm_pose(robot, q).matrix() - X_RH.matrix()).cwiseAbs().maxCoeff();
        ASSERT_LT(residual, 1e-10) << "kind " << kind << " q " << wanted.transpose();
        for (int i = 0; i < 6; ++i) {
          ASSERT_GE(q[i], robot.lower()[i]);
          ASSERT_LE(q[i], robot.upper()[i]);
        }
        nearest = std::min(nearest, (q - wanted).cwiseAbs().maxCoeff());
      }
      // Beside a wrist singularity joint 6 is free, so that the position itself need not come back.
      if (kind == 0) {
        ASSERT_LT(nearest, 1e-6) << wanted.transpose();
      }
      // At the elbow's the position moves by the square root of the pose's rounding.
      if (kind == 2) {
        ASSERT_LT(nearest, 1e-4) << wanted.transpose();
      }
      const std::vector<VectorXd> branches = arm.branches(X_RH);
      ASSERT_LE(branches.size(), 8u);
      for (std::size_t i = 0; i < branches.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) ASSERT_GT(turns_apart(branches[i], branches[j]), 1e-6);
      }
    }
  }
}

TEST(ArmKinematics, RoundTripsOnOurRobot) { check_round_trips(RobotModel(load_robot(our_robot()))); }

TEST(ArmKinematics, RoundTripsOnTheRealRobots) {
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const std::string folder = OPPONENS_SOURCE_DIR "/tests/data/robots/";
  for (const char* name : {"example_ur5_allegro_right.yaml", "paper_lab_ur5_allegro_right_urdf.yaml"}) {
    SCOPED_TRACE(name);
    check_round_trips(RobotModel(load_robot(folder + name)));
  }
}

TEST(ArmKinematics, GivesAllEightBranchesAndEveryTurn) {
  const RobotModel robot(load_robot(our_robot()));
  const ArmKinematics arm(robot);
  VectorXd q(6);
  q << 0.3, -1.2, 1.4, -0.9, 0.8, 0.5;
  EXPECT_EQ(arm.branches(palm_pose(robot, q)).size(), 8u);
  // Five joints of two turns each, the elbow has one.
  EXPECT_EQ(arm.solve(palm_pose(robot, q)).size(), 8u * 32u);
}

TEST(ArmKinematics, HoldsItsChoiceAtTheWristSingularity) {
  const RobotModel robot(load_robot(our_robot()));
  const ArmKinematics arm(robot);
  VectorXd q(6);
  q << 0.3, -1.2, 1.4, -0.9, 0.0, 0.7;
  const std::vector<VectorXd> branches = arm.branches(palm_pose(robot, q));
  ASSERT_FALSE(branches.empty());
  int straight = 0;
  for (const VectorXd& branch : branches) {
    if (std::abs(std::remainder(branch[4], kPi)) > 1e-9) continue;  // the other shoulder has a bent wrist
    ++straight;
    EXPECT_NEAR(branch[5], 0.0, 1e-9);
  }
  EXPECT_EQ(straight, 2);
}

TEST(ArmKinematics, NothingBeyondReachAndNothingFromNan) {
  const RobotModel robot(load_robot(our_robot()));
  const ArmKinematics arm(robot);
  Isometry3d X_RH = Isometry3d::Identity();
  X_RH.translation() << 2.0, 0, 0;
  EXPECT_TRUE(arm.solve(X_RH).empty());
  X_RH.translation() << 0, 0, 0.1;  // the wrist inside the shoulder's cylinder
  for (const VectorXd& q : arm.solve(X_RH)) EXPECT_TRUE(q.allFinite());
  X_RH.translation().x() = std::nan("");
  EXPECT_THROW(arm.solve(X_RH), std::invalid_argument);
}

TEST(ArmKinematics, RefusesOtherArms) {
  RobotDescription description = load_robot(our_robot());
  const auto message = [](const RobotDescription& changed) {
    try {
      const ArmKinematics arm{RobotModel(changed)};
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message(description), "accepted");
  RobotDescription tilted = description;
  for (Joint& joint : tilted.joints) {
    if (joint.name == "elbow_joint") joint.X_PJ.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  }
  EXPECT_NE(message(tilted).find("parallel"), std::string::npos) << message(tilted);
  RobotDescription shorter = description;
  shorter.arm_joints.pop_back();
  shorter.weights.resize(0);
  EXPECT_NE(message(shorter).find("6 joints"), std::string::npos) << message(shorter);
}

}  // namespace
}  // namespace opponens::robot
