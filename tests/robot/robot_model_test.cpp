// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/robot_model.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd random_position(const RobotModel& robot, Rng& rng) {
  VectorXd q(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
  return q;
}

/// Robots that every kinematic test runs on: ours, and the real ones where the data folder is present.
std::vector<RobotDescription> robots() {
  std::vector<RobotDescription> all = {load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")),
                                       load_hand(ours("human_hand/human_hand.yaml"))};
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) return all;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const std::string folder = OPPONENS_SOURCE_DIR "/tests/data/robots/";
  all.push_back(load_robot(folder + "example_ur5_allegro_right.yaml"));
  all.push_back(load_robot(folder + "paper_lab_ur5_allegro_right_urdf.yaml"));
  all.push_back(load_robot(folder + "paper_lab_ur5_allegro_right_visual.yaml"));
  all.push_back(load_hand(folder + "dex_allegro_right.yaml"));
  all.push_back(load_hand(folder + "example_allegro_right.yaml"));
  const std::string hands = OPPONENS_SHARED_DATA "/data/robots/dex-urdf/robots/hands/";
  all.push_back(load_hand(ours("shadow_hand/shadow_right.yaml"), hands + "shadow_hand/shadow_hand_right.urdf"));
  all.push_back(load_hand(ours("barrett_hand/barrett_right.yaml"), hands + "barrett_hand/bhand_model.urdf"));
  return all;
}

/// prismatic slider p along x, then revolute r about z, then m = -2 r + 0.3 about z that mimics r; 1 m apart.
RobotDescription slider() {
  RobotDescription d;
  d.name = "slider";
  for (const char* link : {"root", "carriage", "arm", "tip"}) d.links.push_back({link, -1, {}});
  for (int i = 0; i < 3; ++i) {
    Joint joint;
    joint.name = std::string(1, "prm"[i]);
    joint.type = i == 0 ? JointType::prismatic : JointType::revolute;
    joint.axis = i == 0 ? Vector3d::UnitX() : Vector3d::UnitZ();
    joint.parent = i;
    joint.child = i + 1;
    joint.X_PJ.translation() = Vector3d(i == 0 ? 0.0 : 1.0, 0, 0);
    joint.lower = -1.5;
    joint.upper = 1.5;
    d.links[static_cast<std::size_t>(i) + 1].joint = i;
    d.joints.push_back(joint);
  }
  d.joints[2].mimic = Mimic{"r", -2.0, 0.3};
  d.arm_joints = {"p"};
  d.hand_joints = {"r"};
  return d;
}

/// Product of exponentials about the axes of the zero pose (Lynch and Park 2017, section 4.1): shares no frame
/// recursion with link_poses.
Isometry3d by_exponentials(const RobotModel& robot, const VectorXd& q, int link) {
  const std::vector<Isometry3d> zero = robot.link_poses(VectorXd::Zero(robot.dof()));
  const auto& names = robot.joint_names();
  Isometry3d X = zero[static_cast<std::size_t>(link)];
  while (robot.links()[static_cast<std::size_t>(link)].joint >= 0) {
    const Joint& joint =
        robot.description().joints[static_cast<std::size_t>(robot.links()[static_cast<std::size_t>(link)].joint)];
    const auto name = std::find(names.begin(), names.end(), joint.mimic ? joint.mimic->joint : joint.name);
    if (name != names.end()) {  // the zero pose has the offsets of mimic joints
      const double position = (joint.mimic ? joint.mimic->multiplier : 1.0) * q[name - names.begin()];
      const Isometry3d& X_J = zero[static_cast<std::size_t>(link)];
      const Vector3d w = X_J.linear() * joint.axis;
      Isometry3d motion = Isometry3d::Identity();
      if (joint.type == JointType::prismatic) {
        motion.translation() = position * w;
      } else {
        motion.linear() = Eigen::AngleAxisd(position, w).toRotationMatrix();
        motion.translation() = X_J.translation() - motion.linear() * X_J.translation();
      }
      X = motion * X;
    }
    link = joint.parent;
  }
  return X;
}

TEST(RobotModel, MatchesTheProductOfExponentials) {
  std::vector<RobotDescription> all = robots();
  all.push_back(slider());
  for (const RobotDescription& description : all) {
    const RobotModel robot(description);
    Rng rng(5);
    for (int sample = 0; sample < 20; ++sample) {
      const VectorXd q = random_position(robot, rng);
      const std::vector<Isometry3d> X_RL = robot.link_poses(q);
      for (std::size_t link = 0; link < X_RL.size(); ++link) {
        const Isometry3d other = by_exponentials(robot, q, static_cast<int>(link));
        EXPECT_LT((X_RL[link].matrix() - other.matrix()).cwiseAbs().maxCoeff(), 1e-12)
            << description.name << " " << robot.links()[link].name << " q " << q.transpose();
        EXPECT_LT((X_RL[link].linear() * X_RL[link].linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      }
    }
  }
}

/// Universal Robots' published Denavit-Hartenberg table.
TEST(RobotModel, Ur5FlangeFollowsThePublishedTable) {
  const RobotModel robot(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")));
  const double d[] = {0.089159, 0, 0, 0.10915, 0.09465, 0.0823};
  const double a[] = {0, -0.425, -0.39225, 0, 0, 0};
  const double right = std::numbers::pi / 2;
  const double alpha[] = {right, 0, 0, right, -right, 0};
  Rng rng(6);
  for (int sample = 0; sample < 50; ++sample) {
    const VectorXd q = random_position(robot, rng);
    Isometry3d X = Isometry3d::Identity();
    for (int i = 0; i < 6; ++i) {
      const double c = std::cos(q[i]), s = std::sin(q[i]), ca = std::cos(alpha[i]), sa = std::sin(alpha[i]);
      Isometry3d A = Isometry3d::Identity();
      A.matrix().topRows<3>() << c, -s * ca, s * sa, a[i] * c, s, c * ca, -c * sa, a[i] * s, 0, sa, ca, d[i];
      X = X * A;
    }
    const Isometry3d flange = robot.link_poses(q)[static_cast<std::size_t>(robot.link_index("tool0"))];
    EXPECT_LT((flange.matrix() - X.matrix()).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(RobotModel, JacobianIsTheDerivativeOfThePoint) {
  std::vector<RobotDescription> all = robots();
  all.push_back(slider());
  for (const RobotDescription& description : all) {
    const RobotModel robot(description);
    Rng rng(7);
    double largest = 0.0;
    for (int sample = 0; sample < 5; ++sample) {
      const VectorXd q = random_position(robot, rng);
      const int link = static_cast<int>(robot.links().size()) - 1 - sample % 3;
      const Vector3d p_L(0.1, -0.2, 0.3);
      const auto X_RL = robot.link_poses(q);
      const Eigen::Matrix3Xd J = robot.point_jacobian(X_RL, link, X_RL[static_cast<std::size_t>(link)] * p_L);
      largest = std::max(largest, J.cwiseAbs().maxCoeff());
      for (int i = 0; i < robot.dof(); ++i) {
        const double h = 1e-6;
        const auto at = [&](double step) {
          VectorXd moved = q;
          moved[i] += step;
          return (robot.link_poses(moved)[static_cast<std::size_t>(link)] * p_L).eval();
        };
        EXPECT_LT(((at(h) - at(-h)) / (2 * h) - J.col(i)).norm(), 1e-8) << description.name << " joint " << i;
      }
    }
    EXPECT_GT(largest, 0.01) << "nothing moved: the comparison would hold for zeros";
  }
}

TEST(RobotModel, SliderAndMimicByHand) {
  const RobotModel robot(slider());
  const auto X = robot.link_poses(Eigen::Vector2d(0.5, 0.4));
  EXPECT_NEAR(X[1].translation().x(), 0.5, 1e-15);
  // arm at x = 1.5 turned by 0.4; tip 1 m further along it, turned by 0.4 - 0.8 + 0.3.
  EXPECT_LT((X[3].translation() - Vector3d(1.5 + std::cos(0.4), std::sin(0.4), 0)).norm(), 1e-15);
  EXPECT_NEAR(std::atan2(X[3].linear()(1, 0), X[3].linear()(0, 0)), -0.1, 1e-15);
}

TEST(RobotModel, JointsThatAreNotActuatedRestNearestToZero) {
  RobotDescription description = slider();
  description.hand_joints.clear();
  description.joints[1].lower = 0.25;
  const RobotModel robot(description);
  const auto X = robot.link_poses(VectorXd::Zero(1));
  EXPECT_NEAR(std::atan2(X[2].linear()(1, 0), X[2].linear()(0, 0)), 0.25, 1e-15);
  EXPECT_NEAR(std::atan2(X[3].linear()(1, 0), X[3].linear()(0, 0)), 0.25 - 0.5 + 0.3, 1e-15);
}

TEST(RobotModel, ClipAndLimits) {
  const RobotModel robot(slider());
  EXPECT_EQ(robot.clip(Eigen::Vector2d(-9, -9)).x(), -1.5);
  EXPECT_EQ(robot.clip(Eigen::Vector2d(9, 9)).x(), 1.5);
  EXPECT_TRUE(robot.within_limits(Eigen::Vector2d(1.5, 0)));
  EXPECT_FALSE(robot.within_limits(Eigen::Vector2d(1.5 + 1e-6, 0)));
  EXPECT_FALSE(robot.within_limits(Eigen::Vector2d(std::nan(""), 0)));
}

TEST(RobotModel, LimitsOfMimicJointsRestrictTheirDriver) {
  const auto limits = [](auto change) {
    RobotDescription description = slider();
    change(description.joints[2]);
    const RobotModel robot(description);
    return Eigen::Vector2d(robot.lower()[1], robot.upper()[1]);
  };
  // -2 r + 0.3 in [-1.5, 1.5] means r in [-0.6, 0.9].
  EXPECT_TRUE(limits([](Joint&) {}).isApprox(Eigen::Vector2d(-0.6, 0.9), 1e-15));
  EXPECT_TRUE(limits([](Joint& m) { m.mimic->multiplier = 2.0; }).isApprox(Eigen::Vector2d(-0.9, 0.6), 1e-15));
  const Eigen::Vector2d own(-1.5, 1.5);
  EXPECT_EQ(limits([](Joint& m) { m.mimic->multiplier = 0.1; }), own) << "wider than the driver's own";
  EXPECT_EQ(limits([](Joint& m) { m.mimic->multiplier = 0.0; }), own);
  EXPECT_EQ(limits([](Joint& m) { m.lower = m.upper = 0.0; }), own) << "it has none";
  EXPECT_THROW(limits([](Joint& m) { m.mimic->offset = 9.0; }), InputError);
}

TEST(RobotModel, ScalingScalesEveryLength) {
  const RobotDescription hand = load_hand(ours("human_hand/human_hand.yaml"));
  const RobotModel small(hand);
  const RobotModel large(scaled(hand, 1.25));
  Rng rng(8);
  const VectorXd q = random_position(small, rng);
  const auto X = small.link_poses(q);
  const auto Y = large.link_poses(q);
  for (std::size_t i = 0; i < hand.tips.size(); ++i) {
    const auto link = static_cast<std::size_t>(hand.tips[i].link);
    const Vector3d p = X[link] * hand.tips[i].p_L;
    EXPECT_LT((Y[link] * large.description().tips[i].p_L - 1.25 * p).norm(), 1e-14);
  }
  EXPECT_THROW(scaled(hand, 0.0), std::invalid_argument);
}

TEST(RobotModel, RefusesInconsistentDescriptions) {
  const auto refuses = [](auto change) {
    RobotDescription description = slider();
    change(description);
    EXPECT_THROW(RobotModel{description}, std::invalid_argument);
  };
  refuses([](RobotDescription& d) { d.hand_joints = {"absent"}; });
  refuses([](RobotDescription& d) { d.hand_joints = {"p"}; });
  refuses([](RobotDescription& d) { d.hand_joints = {"m"}; });
  refuses([](RobotDescription& d) { d.joints[1].parent = 3; });
  refuses([](RobotDescription& d) { d.joints[1].axis *= 2.0; });
  refuses([](RobotDescription& d) { d.weights = Eigen::Vector3d::Ones(); });
  refuses([](RobotDescription& d) { d.palm_link = "absent"; });
  const RobotModel robot(slider());
  EXPECT_THROW(robot.link_poses(VectorXd::Zero(3)), std::invalid_argument);
  EXPECT_THROW(robot.link_index("absent"), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::robot
