// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The interface, and damped least squares behind it on arms without a closed form.
#include "robot/inverse_kinematics.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot/ur_kinematics.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

RobotModel other_arm(const std::string& name) {
  return RobotModel(load_robot(OPPONENS_SOURCE_DIR "/tests/data/robots/" + name + "_allegro_right.yaml"));
}
RobotModel ur5() { return RobotModel(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"))); }

/// Pose of a link by the whole robot's forward kinematics, the joints outside the group nearest to zero.
Isometry3d pose(const RobotModel& robot, const PlanningGroup& group, int link, const VectorXd& q_group) {
  VectorXd q = robot.clip(VectorXd::Zero(robot.dof()));
  q.segment(group.first, group.count) = q_group;
  return robot.link_poses(q)[static_cast<std::size_t>(link)];
}

VectorXd any_position(const RobotModel& robot, const PlanningGroup& group, Rng& rng) {
  VectorXd q(group.count);
  for (int i = 0; i < group.count; ++i) {
    q[i] = rng.uniform(robot.lower()[group.first + i], robot.upper()[group.first + i]);
  }
  return q;
}

bool inside(const RobotModel& robot, const PlanningGroup& group, const VectorXd& q) {
  return q.allFinite() && (q.array() >= robot.lower().segment(group.first, group.count).array()).all() &&
         (q.array() <= robot.upper().segment(group.first, group.count).array()).all();
}

/// Every pose of a random position is reached, within the contract; returns the mean number of solutions.
double check_contract(const RobotModel& robot, int poses) {
  const InverseKinematics solve = make_inverse_kinematics(robot);
  Rng rng(21);
  double solutions = 0.0;
  for (int sample = 0; sample < poses; ++sample) {
    const VectorXd wanted = any_position(robot, robot.arm(), rng);
    const Isometry3d X_RH = pose(robot, robot.arm(), robot.palm(), wanted);
    const auto found = solve(X_RH, {});
    EXPECT_TRUE(found) << wanted.transpose() << ": " << found.error().detail;
    if (!found) continue;
    solutions += static_cast<double>(found->size());
    for (std::size_t i = 0; i < found->size(); ++i) {
      const VectorXd& q = (*found)[i];
      EXPECT_TRUE(inside(robot, robot.arm(), q));
      EXPECT_LT((pose(robot, robot.arm(), robot.palm(), q).matrix() - X_RH.matrix()).cwiseAbs().maxCoeff(), 1e-10);
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT((q - (*found)[j]).cwiseAbs().maxCoeff(), 0.04);
    }
    EXPECT_EQ(*solve(X_RH, {}), *found) << "another answer to the same question";
    const auto near = solve(X_RH, {wanted});
    EXPECT_TRUE(near);
    if (near) {
      EXPECT_LT((near->front() - wanted).norm(), 1e-9);
    }
  }
  return solutions / poses;
}

TEST(InverseKinematics, HoldsItsContractOnARedundantArm) {
  EXPECT_GT(check_contract(other_arm("seven_joint"), 100), 8.0);
}

TEST(InverseKinematics, HoldsItsContractOnAGantry) {
  const RobotModel robot = other_arm("gantry");
  // The wrist flips: two solutions where both are inside the limits.
  EXPECT_GT(check_contract(robot, 100), 1.0);
}

TEST(InverseKinematics, OfAUrArmIsAnalytic) {
  const RobotModel robot = ur5();
  VectorXd q(6);
  q << 0.3, -1.2, 1.4, -0.9, 0.8, 0.5;
  const auto found = make_inverse_kinematics(robot)(pose(robot, robot.arm(), robot.palm(), q), {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), 8u * 32u);
  Isometry3d far = Isometry3d::Identity();
  far.translation().x() = 2.0;
  EXPECT_EQ(make_inverse_kinematics(robot)(far, {}).error().code, FailureCode::out_of_reach);
}

/// Two solvers agree: what damped least squares finds is one of the closed form's branches, each found now and then.
TEST(InverseKinematics, DampedLeastSquaresFindsTheAnalyticBranches) {
  const RobotModel robot = ur5();
  const KinematicChain chain = kinematic_chain(robot, robot.arm(), robot.palm());
  const UrKinematics analytic = UrKinematics::of(chain).value();
  Rng rng(22);
  std::size_t branches = 0;
  std::size_t met = 0;
  for (int sample = 0; sample < 50; ++sample) {
    const Isometry3d X_RH = pose(robot, robot.arm(), robot.palm(), any_position(robot, robot.arm(), rng));
    const ArmBranches known = analytic.branches(X_RH);
    const auto found = solve_damped(chain, X_RH, {}, {});
    ASSERT_TRUE(found);
    branches += static_cast<std::size_t>(known.count);
    met += found->size();
    for (const VectorXd& q : *found) {
      const bool one_of_them = std::any_of(known.begin(), known.end(), [&](const Vector6d& branch) {
        return ((branch - q) / (2 * std::numbers::pi))
                   .array()
                   .unaryExpr([](double turns) { return std::abs(turns - std::round(turns)); })
                   .maxCoeff() < 1e-5;
      });
      EXPECT_TRUE(one_of_them) << q.transpose();
    }
  }
  EXPECT_LE(met, branches);
  EXPECT_GT(static_cast<double>(met), 0.6 * static_cast<double>(branches));
}

TEST(InverseKinematics, OfAnyLink) {
  const RobotModel robot = ur5();
  Rng rng(23);
  // The flange is carried by the same six joints, the forearm by three of them, a fingertip's link by hand joints too.
  for (const char* name : {"tool0", "forearm_link"}) {
    const int link = robot.link_index(name);
    const InverseKinematics solve = make_inverse_kinematics(robot, robot.arm(), link);
    for (int sample = 0; sample < 20; ++sample) {
      const Isometry3d X_RT = pose(robot, robot.arm(), link, any_position(robot, robot.arm(), rng));
      const auto found = solve(X_RT, {});
      ASSERT_TRUE(found) << name << " " << found.error().detail;
      for (const VectorXd& q : *found) {
        EXPECT_LT((pose(robot, robot.arm(), link, q).matrix() - X_RT.matrix()).cwiseAbs().maxCoeff(), 1e-10);
        if (link == robot.link_index("forearm_link")) {
          EXPECT_EQ(q.tail<3>(), Vector3d::Zero());
        }
      }
    }
  }
  const int tip = robot.description().tips.front().link;
  const auto finger = make_inverse_kinematics(robot, robot.hand(), tip, {.position_only = true});
  const VectorXd wanted = any_position(robot, robot.hand(), rng);
  const Isometry3d X_RT = pose(robot, robot.hand(), tip, wanted);
  const auto found = finger(X_RT, {});
  ASSERT_TRUE(found);
  for (const VectorXd& q : *found) {
    EXPECT_TRUE(inside(robot, robot.hand(), q));
    EXPECT_LT((pose(robot, robot.hand(), tip, q).translation() - X_RT.translation()).norm(), 1e-10);
  }
  EXPECT_THROW(make_inverse_kinematics(robot, robot.hand(), robot.palm()), std::invalid_argument);
}

TEST(InverseKinematics, PositionsAloneLeaveTheRotationFree) {
  const RobotModel robot = ur5();
  VectorXd q(6);
  q << 0.3, -1.2, 1.4, -0.9, 0.8, 0.5;
  const Isometry3d X_RH = pose(robot, robot.arm(), robot.palm(), q);
  const auto found = make_inverse_kinematics(robot, robot.arm(), robot.palm(), {.position_only = true})(X_RH, {});
  ASSERT_TRUE(found);
  double turned = 0.0;
  for (const VectorXd& other : *found) {
    const Isometry3d X = pose(robot, robot.arm(), robot.palm(), other);
    EXPECT_LT((X.translation() - X_RH.translation()).norm(), 1e-10);
    turned = std::max(turned, (X.linear() - X_RH.linear()).norm());
  }
  EXPECT_GT(turned, 0.1);
}

TEST(InverseKinematics, SolutionsOnTheLimitsAreFound) {
  const RobotModel robot = other_arm("seven_joint");
  Rng rng(24);
  for (int sample = 0; sample < 30; ++sample) {
    VectorXd q = any_position(robot, robot.arm(), rng);
    for (const Eigen::Index i : {1, 3, 5}) q[i] = rng.uniform() < 0.5 ? robot.lower()[i] : robot.upper()[i];
    const Isometry3d X_RH = pose(robot, robot.arm(), robot.palm(), q);
    const auto found = make_inverse_kinematics(robot)(X_RH, {q * 0.98});
    ASSERT_TRUE(found) << q.transpose() << " " << found.error().detail;
    EXPECT_TRUE(inside(robot, robot.arm(), found->front()));
  }
}

TEST(InverseKinematics, SaysHowNearItCame) {
  const RobotModel robot = other_arm("gantry");
  const InverseKinematics solve = make_inverse_kinematics(robot);
  Isometry3d X_RH = Isometry3d::Identity();
  X_RH.translation().x() = 50.0;
  const auto far = solve(X_RH, {});
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, FailureCode::out_of_reach);
  EXPECT_NE(far.error().detail.find("beyond all lengths"), std::string::npos) << far.error().detail;
  // 5 cm above where the column ends, though not farther away than all lengths.
  VectorXd top(6);
  top << 0, 0, 0.9, 0.2, 1.1, 0.3;
  X_RH = pose(robot, robot.arm(), robot.palm(), top);
  X_RH.translation().z() += 0.05;
  const auto above = solve(X_RH, {});
  ASSERT_FALSE(above);
  EXPECT_EQ(above.error().code, FailureCode::out_of_reach) << above.error().detail;
  const std::size_t at = above.error().detail.find("within ");
  ASSERT_NE(at, std::string::npos);
  const double least = std::stod(above.error().detail.substr(at + 7));
  EXPECT_GT(least, 0.005);
  EXPECT_LT(least, 0.0501);
  DampedLeastSquaresSettings hasty;
  hasty.restarts = 1;
  hasty.max_iterations = 1;
  const auto stopped = make_inverse_kinematics(robot, robot.arm(), robot.palm(), hasty)(X_RH, {});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, FailureCode::not_converged);
  X_RH.translation().z() = std::nan("");
  EXPECT_THROW(solve(X_RH, {}), std::invalid_argument);
}

TEST(InverseKinematics, RefusesBadSettings) {
  const RobotModel robot = ur5();
  const auto refuses = [&](const DampedLeastSquaresSettings& settings) {
    EXPECT_THROW(make_inverse_kinematics(robot, robot.arm(), robot.palm(), settings), std::invalid_argument);
  };
  refuses({.restarts = 0});
  refuses({.max_iterations = 0});
  refuses({.max_solutions = 0});
  refuses({.tolerance = 0.0});
  refuses({.apart = 0.0});
}

/// A slide that a second one mimics with factor -2, then a hinge that a second one mimics with factor 0.5.
RobotModel coupled() {
  RobotDescription d;
  d.name = "coupled";
  for (int i = 0; i < 5; ++i) d.links.push_back({"link" + std::to_string(i), i - 1, {}});
  for (int i = 0; i < 4; ++i) {
    Joint joint;
    joint.name = "joint" + std::to_string(i);
    joint.type = i < 2 ? JointType::prismatic : JointType::revolute;
    joint.axis = i == 0 ? Vector3d::UnitX() : i == 1 ? Vector3d::UnitY() : Vector3d(0, 0.6, 0.8);
    joint.parent = i;
    joint.child = i + 1;
    joint.X_PJ.translation() = Vector3d(0.3, 0, 0.1);
    joint.lower = -2.0;
    joint.upper = 2.0;
    d.joints.push_back(joint);
  }
  d.joints[1].mimic = Mimic{"joint0", -2.0, 0.1};
  d.joints[3].mimic = Mimic{"joint2", 0.5, -0.2};
  d.arm_joints = {"joint0", "joint2"};
  d.palm_link = "link4";
  return RobotModel(d);
}

TEST(InverseKinematics, FollowsMimicJoints) {
  const RobotModel robot = coupled();
  const InverseKinematics solve = make_inverse_kinematics(robot);
  Rng rng(25);
  for (int sample = 0; sample < 50; ++sample) {
    const VectorXd q = any_position(robot, robot.arm(), rng);
    const auto found = solve(pose(robot, robot.arm(), robot.palm(), q), {});
    ASSERT_TRUE(found) << q.transpose() << " " << found.error().detail;
    EXPECT_LT((found->front() - q).norm(), 1e-8);
  }
}

TEST(KinematicChain, AgreesWithTheTreeAndItsJacobianWithDifferences) {
  const RobotModel robots[] = {ur5(), other_arm("seven_joint"), other_arm("gantry"), coupled()};
  Rng rng(26);
  for (const RobotModel& robot : robots) {
    const KinematicChain chain = kinematic_chain(robot, robot.arm(), robot.palm());
    for (int sample = 0; sample < 20; ++sample) {
      const VectorXd q = any_position(robot, robot.arm(), rng);
      Eigen::Matrix<double, 6, Eigen::Dynamic> J;
      const Isometry3d X = tip_pose(chain, q, J);
      EXPECT_LT((X.matrix() - pose(robot, robot.arm(), robot.palm(), q).matrix()).cwiseAbs().maxCoeff(), 1e-14);
      EXPECT_GT(J.cwiseAbs().maxCoeff(), 0.1);
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        constexpr double kStep = 1e-6;
        const VectorXd step = kStep * VectorXd::Unit(q.size(), i);
        const Vector6d difference = pose_error(tip_pose(chain, q - step), tip_pose(chain, q + step)) / (2 * kStep);
        EXPECT_LT((difference - J.col(i)).norm(), 1e-8) << robot.description().name << " joint " << i;
      }
    }
  }
}

TEST(Descent, ConvergesQuadraticallyAwayFromSingularities) {
  const RobotModel robot = other_arm("seven_joint");
  const KinematicChain chain = kinematic_chain(robot, robot.arm(), robot.palm());
  VectorXd q(7);
  q << 0.2, 0.6, -0.3, -1.2, 0.4, 0.9, 0.1;
  const VectorXd start = q + VectorXd::Constant(7, 0.02);
  const Descent descent = descend(chain, {tip_pose(chain, q)}, start, 100, 1e-13);
  EXPECT_LT(descent.residual, 1e-13);
  EXPECT_LE(descent.iterations, 6);
}

}  // namespace
}  // namespace opponens::robot
