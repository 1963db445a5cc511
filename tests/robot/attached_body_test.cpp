// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/attached_body.hpp"

#include <gtest/gtest.h>

#include "robot/collision.hpp"
#include "robot/load_robot.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

/// The one-arm robot with a bottle across its palm, between the fingers, in front of a shelf.
class AttachedBody : public ::testing::Test {
 protected:
  AttachedBody() {
    q_ << -0.1, -1.15, -2.35, -3.1, -1.67, -1.6, Eigen::VectorXd::Constant(16, 0.25);
    q_[6 + 12] = 1.3;  // thumb opposed
    X_RH_ = poses(RobotModel(robot_), q_).at(static_cast<std::size_t>(RobotModel(robot_).palm()));
    bottle_.name = "bottle";
    bottle_.geometry = {{Cylinder{0.03, 0.3}, turned()}};
    bottle_.X_WB = X_RH_ * X_HB_;
    scene_.bodies = {bottle_};
    scene_.object = "bottle";
    for (const Link& link : robot_.links) {
      if (link.name.starts_with("link_")) fingers_.push_back(link.name);
    }
  }

  static std::vector<Eigen::Isometry3d> poses(const RobotModel& model, const Eigen::VectorXd& q) {
    return model.link_poses(q);
  }
  /// The cylinder's axis along y of the palm.
  static Eigen::Isometry3d turned() {
    return Eigen::Isometry3d(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()));
  }
  /// A plate of 2 cm thickness whose near face is `gap` beyond the bottle's end.
  SceneBody shelf(double gap) const {
    SceneBody body{"shelf", X_RH_ * X_HB_ * at(0, 0.15 + gap + 0.01, 0), {}};
    body.geometry = {{Box{{0.4, 0.02, 0.4}}}};
    return body;
  }

  RobotDescription robot_ = load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"));
  Eigen::VectorXd q_ = Eigen::VectorXd(22);
  Eigen::Isometry3d X_RH_;
  Eigen::Isometry3d X_HB_ = at(0.045, 0.05, 0.04);
  SceneBody bottle_;
  Scene scene_;
  std::vector<std::string> fingers_;
};

TEST_F(AttachedBody, HeldBottleHitsAShelfButNotTheFingersThatHoldIt) {
  const CollisionChecker before(RobotModel(robot_), scene_);
  const std::vector<BodyPair> grip = before.colliding_pairs(q_);
  ASSERT_FALSE(grip.empty()) << "the fingers press into the bottle here, so that allowing them means something";
  for (const BodyPair& pair : grip) EXPECT_EQ(pair.second, "bottle");

  const Scene emptied = without_body(scene_, "bottle");
  EXPECT_TRUE(CollisionChecker(RobotModel(robot_), emptied).free(q_)) << "the arm alone is clear";
  const RobotModel holding(attach_body(robot_, bottle_, "palm_link", X_HB_, fingers_));
  EXPECT_TRUE(CollisionChecker(holding, emptied).free(q_));
  const RobotModel careless(attach_body(robot_, bottle_, "palm_link", X_HB_, {}));
  EXPECT_EQ(CollisionChecker(careless, emptied).colliding_pairs(q_).size(), grip.size()) << "no finger was allowed";

  for (const double gap : {0.001, -0.001}) {
    Scene shelved = emptied;
    shelved.bodies.push_back(shelf(gap));
    EXPECT_TRUE(CollisionChecker(RobotModel(robot_), shelved).free(q_)) << "the hand itself does not reach the shelf";
    const CollisionChecker checker(holding, shelved);
    if (gap > 0) {
      EXPECT_TRUE(checker.free(q_));
      EXPECT_NEAR(checker.clearance(q_).distance, gap, 1e-6);
      EXPECT_EQ(checker.clearance(q_).pair, BodyPair("bottle", "shelf"));
    } else {
      EXPECT_EQ(checker.colliding_pairs(q_), (std::vector<BodyPair>{{"bottle", "shelf"}}));
    }
  }
}

TEST_F(AttachedBody, MovesWithTheLinkAndHitsTheArm) {
  const RobotModel holding(attach_body(robot_, bottle_, "palm_link", X_HB_, fingers_));
  EXPECT_EQ(holding.dof(), 22);
  Eigen::VectorXd q = q_;
  q[0] = 1.0;
  q[4] = 0.3;
  const auto X = holding.link_poses(q);
  const Eigen::Isometry3d expected = X[static_cast<std::size_t>(holding.palm())] * X_HB_;
  EXPECT_LT((X.back().matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-12);

  // A long rod held along the fingers and back through the forearm: a pair that only the attached link can have.
  SceneBody rod{"rod", {}, {{Cylinder{0.02, 1.6}}}};
  const RobotModel rodded(attach_body(robot_, rod, "palm_link", at(0.04, 0, 0), fingers_));
  const std::vector<BodyPair> pairs = CollisionChecker(rodded, Scene{}).colliding_pairs(q_);
  ASSERT_FALSE(pairs.empty());
  for (const BodyPair& pair : pairs) {
    EXPECT_TRUE(pair.first == "rod" || pair.second == "rod");
    const std::string other = pair.first == "rod" ? pair.second : pair.first;
    EXPECT_TRUE(other != "tool0" && other != "support" && other != "wrist_3_link") << "rigidly joined to the palm";
  }
}

TEST_F(AttachedBody, TwoBodiesAndNames) {
  const RobotDescription one = attach_body(robot_, bottle_, "palm_link", X_HB_, fingers_);
  SceneBody cap{"cap", {}, {{Sphere{0.02}}}};
  const RobotModel two(attach_body(one, cap, "bottle", at(0, 0.15, 0), {}));
  EXPECT_TRUE(CollisionChecker(two, Scene{}).free(q_)) << "the cap is rigidly joined to the bottle";
  EXPECT_THROW(attach_body(one, bottle_, "palm_link", X_HB_, {}), std::invalid_argument) << "the name is taken";
  EXPECT_THROW(attach_body(robot_, bottle_, "palm", X_HB_, {}), std::invalid_argument);
  EXPECT_THROW(attach_body(robot_, bottle_, "palm_link", X_HB_, {"link_99"}), std::invalid_argument);
  EXPECT_THROW(without_body(scene_, "glass"), std::invalid_argument);
  EXPECT_EQ(without_body(scene_, "bottle").object, "");
  EXPECT_EQ(scene_.bodies.size(), 1u) << "the scene given is a value that stays";
}

}  // namespace
}  // namespace opponens::robot
