// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "analysis/synergy_box.hpp"
#include "motion/blended_path.hpp"
#include "motion/edge_check.hpp"
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
  std::vector<SynergyBox> before;
  std::vector<SynergyBox> after;
  const Eigen::VectorXd start = robot.rest();
  Eigen::VectorXd goal = start;
  for (const robot::DrivenArm& arm : robot.arms()) {
    goal[arm.arm.first] += arm.name == "right" ? 0.4 : -0.4;  // both shoulders turn
    goal[arm.arm.first + 5] += 0.5;
    goal.segment(arm.hand.first, arm.hand.count).array() += 0.2;
    goal = robot.clip(goal);
    before.push_back(box_around(start.segment(arm.hand.first, arm.hand.count)));
    after.push_back(box_around(goal.segment(arm.hand.first, arm.hand.count)));
  }
  const SynergyBox start_box = analysis::product_box(before);
  const SynergyBox goal_box = analysis::product_box(after);
  PlannerSettings settings;
  settings.step = 0.8;
  settings.full_space_probability = 0.0;
  const auto planned_once = [&] {
    return plan(start, start_box, {{goal, goal_box, 0}}, robot.joint_names(), robot.hand(), robot.lower(),
                robot.upper(), robot.weights(), world, settings, 1);
  };
  const PlanResult planned = planned_once();
  ASSERT_EQ(planned.status, PlanStatus::solved) << planned.detail;
  EXPECT_EQ(planned_once().path.waypoints, planned.path.waypoints);

  const FollowedBoxes boxes =
      followed_boxes(planned.path.waypoints, planned.bridge_row, box_distance(start_box, robot.hand()),
                     box_distance(goal_box, robot.hand()));
  const Shortcut shorter = shortcut_in_boxes(planned.path, robot.weights(), world, boxes, robot.arm(), 1);
  EXPECT_TRUE(change_row(boxes, shorter.path.waypoints));
  const RateLimits limits{robot.velocity(), robot.acceleration()};
  const Trajectory trajectory = time_optimal(blend_corners(shorter.path.waypoints, world, {}, &boxes), limits, {});
  EXPECT_TRUE(change_row(boxes, trajectory.positions));
  EXPECT_GE(trajectory.times[trajectory.times.size() - 1], least_duration(trajectory.positions, limits));
}

}  // namespace
}  // namespace opponens::motion
