// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/free_joints.hpp"

#include <gtest/gtest.h>

#include "allegro.hpp"
#include "grasp/close_hand.hpp"

namespace opponens::grasp {
namespace {

TEST(FreeJoints, BendingJointsCloseAndSpreadingOnesDoNot) {
  const Eigen::VectorXd closing = closing_joints(test::allegro());
  for (const int finger : {0, 4, 8}) {
    EXPECT_LT(std::abs(closing[finger]), 0.3) << "abduction of finger " << finger;
    for (int j = 1; j < 4; ++j) EXPECT_GT(closing[finger + j], 0.7) << "flexion " << finger + j;
  }
  EXPECT_GT(closing[14], 0.7);
  EXPECT_GT(closing[15], 0.7);
}

TEST(FreeJoints, BoxesAreInsideTheLimitsAndTheHandClosesFromOneToTheOther) {
  const robot::RobotModel& hand = test::allegro();
  const FreeJoints free = free_joints(hand);
  for (const SynergyBox* box : {&free.group.box, &free.pre_grasp}) {
    EXPECT_TRUE(hand.within_limits(box->center + box->half_width));
    EXPECT_TRUE(hand.within_limits(box->center - box->half_width));
    EXPECT_TRUE(box->axes.isIdentity());
  }
  const Eigen::VectorXd direction = closing_direction(free.group.box, free.pre_grasp);
  EXPECT_GT(direction.dot(closing_joints(hand)), 0.0);
  for (const int finger : {0, 4, 8}) EXPECT_EQ(direction[finger], 0.0);  // spreading is not part of closing
  // A joint that does not close has all of its range.
  EXPECT_NEAR(2.0 * free.group.box.half_width[0], hand.upper()[0] - hand.lower()[0], 1e-12);
}

}  // namespace
}  // namespace opponens::grasp
