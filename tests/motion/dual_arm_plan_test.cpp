// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "analysis/synergy_box.hpp"
#include "motion/blended_path.hpp"
#include "motion/edge_check.hpp"
#include "motion/hands_projection.hpp"
#include "motion/shortcut.hpp"
#include "motion/syn_planner.hpp"
#include "motion/time_optimal.hpp"
#include "robot/load_robot.hpp"

namespace opponens::motion {
namespace {

/// Two synergies around a posture: all fingers close together, and the first joints alone.
SynergyBox box_around(const Eigen::VectorXd& q_h) {
  SynergyBox box;
  box.center = q_h;
  box.axes = Eigen::MatrixXd::Zero(q_h.size(), 2);
  for (Eigen::Index i = 0; i < q_h.size(); ++i) box.axes(i, i % 4 == 0 ? 1 : 0) = 1.0;
  box.axes.colwise().normalize();
  box.half_width = Eigen::Vector2d(0.4, 0.1);
  box.scale = Eigen::VectorXd::Ones(q_h.size());
  return box;
}

/// Both arms of the paper's robot at once: 44 joints, each hand along its own synergies.
TEST(DualArmPlan, BothArmsAtOnceEachHandAlongItsOwnBox) {
  const std::filesystem::path models = std::filesystem::path(OPPONENS_SOURCE_DIR) / "models";
  const robot::RobotModel robot(robot::load_robot(models / "dual_ur5_allegro/dual_ur5_allegro.yaml", "both"));
  ASSERT_EQ(robot.dof(), 44);
  const robot::CollisionChecker checker(robot, robot::load_scene(models / "scenes/dual_bookshelf.yaml"));
  const World world = make_world(checker, robot, 0.02);
  std::vector<HandBox> before;
  std::vector<HandBox> after;
  const Eigen::VectorXd start = robot.rest();
  Eigen::VectorXd goal = start;
  for (const robot::DrivenArm& arm : robot.arms()) {
    goal[arm.arm.first] += arm.name == "right" ? 0.4 : -0.4;  // both shoulders turn
    goal[arm.arm.first + 5] += 0.5;
    goal.segment(arm.hand.first, arm.hand.count).array() += 0.2;
    goal = robot.clip(goal);
    before.push_back({box_around(start.segment(arm.hand.first, arm.hand.count)), arm.hand});
    after.push_back({box_around(goal.segment(arm.hand.first, arm.hand.count)), arm.hand});
  }
  const PlanQuery query{{start, hands_projection(before, robot.lower(), robot.upper()), -1},
                        {{goal, hands_projection(after, robot.lower(), robot.upper()), 0}},
                        robot.joint_names(),
                        robot.lower(),
                        robot.upper(),
                        robot.weights()};
  PlannerSettings settings;
  settings.step = 0.8;
  settings.full_space_probability = 0.0;
  const PlanResult planned = plan(query, world, settings, 1);
  ASSERT_EQ(planned.status, PlanStatus::solved) << planned.detail;
  EXPECT_EQ(plan(query, world, settings, 1).path.waypoints, planned.path.waypoints);

  const FollowedBoxes boxes =
      followed_boxes(planned.path.waypoints, planned.bridge_row, hands_distance(before), hands_distance(after));
  const Shortcut shorter = shortcut_in_boxes(planned.path, robot.weights(), world, boxes, robot.arm(), 1);
  EXPECT_TRUE(change_row(boxes, shorter.path.waypoints));
  const RateLimits limits{robot.velocity(), robot.acceleration()};
  const Trajectory trajectory = time_optimal(blend_corners(shorter.path.waypoints, world, {}, &boxes), limits, {});
  EXPECT_TRUE(change_row(boxes, trajectory.positions));
  EXPECT_GE(trajectory.times[trajectory.times.size() - 1], least_duration(trajectory.positions, limits));
}

TEST(DualArmPlan, EachHandIsProjectedAlone) {
  const PlanningGroup left{"left", {}, 2, 16};
  const PlanningGroup right{"right", {}, 18, 16};
  const SynergyBox first = box_around(Eigen::VectorXd::Constant(16, 0.1));
  const SynergyBox second = box_around(Eigen::VectorXd::Constant(16, 0.9));
  const Eigen::VectorXd lower = Eigen::VectorXd::Constant(34, -3.0);
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(34, -1.0, 2.0);
  const Eigen::VectorXd projected = hands_projection({{first, left}, {second, right}}, lower, -lower)(q);
  EXPECT_EQ(projected.head(2), q.head(2));
  EXPECT_LT((projected.segment(2, 16) - analysis::project(first, q.segment(2, 16))).norm(), 1e-12);
  EXPECT_LT((projected.tail(16) - analysis::project(second, q.tail(16))).norm(), 1e-12);
  EXPECT_LT(hands_distance({{first, left}, {second, right}})(projected), 1e-12);
  EXPECT_GT(hands_distance({{first, left}, {second, right}})(q), 0.1);
  EXPECT_THROW(hands_projection({{first, left}, {second, {"x", {}, 10, 16}}}, lower, -lower), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::motion
