// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/hand_shape.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::VectorXd;

VectorXd any_position(const RobotModel& hand, Rng& rng) {
  VectorXd q(hand.dof());
  for (int i = 0; i < hand.dof(); ++i) q[i] = rng.uniform(hand.lower()[i], hand.upper()[i]);
  return q;
}

std::vector<TipPosition> tips_at(const RobotModel& hand, const VectorXd& q) {
  const auto X = hand.link_poses(q);
  const Eigen::Isometry3d X_HR = X[static_cast<std::size_t>(hand.palm())].inverse();
  std::vector<TipPosition> tips;
  for (const SurfacePoint& tip : hand.description().tips) {
    tips.push_back({tip.name, X_HR * X[static_cast<std::size_t>(tip.link)] * tip.p_L});
  }
  return tips;
}

void check_shapes(const RobotModel& hand, int shapes) {
  Rng rng(41);
  const VectorXd start = hand.clip(VectorXd::Zero(hand.dof()));
  for (int sample = 0; sample < shapes; ++sample) {
    const std::vector<TipPosition> wanted = tips_at(hand, any_position(hand, rng));
    const auto shape = shape_hand(hand, wanted, start);
    ASSERT_TRUE(shape) << "sample " << sample << ": " << shape.error().detail;
    EXPECT_TRUE(hand.within_limits(shape->q, 0.0));
    const std::vector<TipPosition> reached = tips_at(hand, shape->q);
    for (std::size_t f = 0; f < wanted.size(); ++f) {
      EXPECT_LT((reached[f].p_H - wanted[f].p_H).norm(), 1e-7);
      EXPECT_NEAR(shape->miss[static_cast<Eigen::Index>(f)], (reached[f].p_H - wanted[f].p_H).norm(), 1e-12);
    }
    EXPECT_EQ(shape_hand(hand, wanted, start)->q, shape->q);
  }
}

TEST(HandShape, ReachesFingertipsOfTheAllegro) {
  check_shapes(RobotModel(load_hand(ours("ur5_allegro/allegro_right.yaml"))), 20);
}

TEST(HandShape, OfAWholeRobotLeavesTheArm) {
  const RobotModel robot(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml")));
  Rng rng(42);
  const VectorXd start = any_position(robot, rng);
  const auto shape = shape_hand(robot, tips_at(robot, any_position(robot, rng)), start);
  ASSERT_TRUE(shape) << shape.error().detail;
  EXPECT_EQ(shape->q.head<6>(), start.head<6>());
}

/// A position behind the back of the hand.
TEST(HandShape, SaysByHowMuchItMissesAndGivesTheNearestWhenAsked) {
  const RobotModel hand(load_hand(ours("ur5_allegro/allegro_right.yaml")));
  const VectorXd start = hand.clip(VectorXd::Zero(hand.dof()));
  std::vector<TipPosition> wanted = tips_at(hand, start);
  wanted.resize(1);
  wanted[0].p_H += Eigen::Vector3d(0, 0, 0.3);
  const auto none = shape_hand(hand, wanted, start);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, FailureCode::out_of_reach) << none.error().detail;
  HandShapeSettings nearest;
  nearest.tolerance = std::numeric_limits<double>::infinity();
  const auto shape = shape_hand(hand, wanted, start, nearest);
  ASSERT_TRUE(shape);
  EXPECT_GT(shape->miss[0], 0.2);
  EXPECT_LT(shape->miss[0], 0.31);
}

TEST(HandShape, RefusesWhatItDoesNotKnow) {
  const RobotModel hand(load_hand(ours("ur5_allegro/allegro_right.yaml")));
  const VectorXd start = hand.clip(VectorXd::Zero(hand.dof()));
  EXPECT_EQ(shape_hand(hand, {{"tail", Eigen::Vector3d::Zero()}}, start).error().code, FailureCode::not_found);
  EXPECT_THROW(shape_hand(hand, {}, start), std::invalid_argument);
  EXPECT_THROW(shape_hand(hand, tips_at(hand, start), VectorXd::Zero(3)), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::robot
