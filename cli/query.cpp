// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/query.hpp"

#include <iterator>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

/// Appends an arm's grasps, and its goals in their order.
void add_grasps(Query& query, std::vector<Stored<Grasp>> grasps) {
  std::vector<ArmGoal> goals;
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    for (std::size_t j = 0; j < grasps[i].value.arm_solutions.size(); ++j)
      goals.push_back({query.grasps.size() + i, j});
  }
  query.arm_goals.push_back(std::move(goals));
  std::move(grasps.begin(), grasps.end(), std::back_inserter(query.grasps));
}

void place(const robot::DrivenArm& arm, const Eigen::VectorXd& q_arm, const Eigen::VectorXd& q_hand,
           Eigen::VectorXd& q) {
  require(q_arm.size() == arm.arm.count && q_hand.size() == arm.hand.count,
          "plan: a stored grasp has another number of joints than the robot");
  q.segment(arm.arm.first, arm.arm.count) = q_arm;
  q.segment(arm.hand.first, arm.hand.count) = q_hand;
}

/// The command that finds grasps for an arm, in full where there is a choice of arms.
std::string grasp_command(const NamedWorld& world, const GraspingArm& arm) {
  if (world.arms.size() == 1) return "opponens grasp";
  return "opponens grasp --robot " + file_with_arm(world, arm.name) + " --scene " +
         world.parameters.at("scene").get<std::string>() + " --object " + arm.object;
}

}  // namespace

void Query::add(Goal goal) {
  goal.root.goal = static_cast<int>(goals.size());
  goals.push_back(std::move(goal.root));
  grasps_of_goal.push_back(std::move(goal.grasps));
  q_grasp.push_back(std::move(goal.q_grasp));
}

std::vector<const Stored<Grasp>*> Query::grasps_at(int goal) const {
  std::vector<const Stored<Grasp>*> reached;
  for (const std::size_t i : grasps_of_goal[static_cast<std::size_t>(goal)]) reached.push_back(&grasps[i]);
  return reached;
}

SynergyBox Query::start_box() const { return analysis::product_box({arm_goals.size(), synergies.pre_grasp.box}); }

Query make_query(const storage::Store& store, const NamedWorld& world) {
  auto synergies = newest_synergies(store);
  Query query;
  query.start = start_configuration(world.robot, world.scene);
  for (const GraspingArm& arm : world.arms) {
    require_same_joints(synergies.value, arm.hand);
    auto grasps = grasps_of(store, synergies.id, world.key(arm));
    if (grasps.empty()) {
      throw InputError(store.directory().string() + ": no grasps of " + arm.object + " with " +
                       (world.arms.size() > 1 ? "arm " + arm.name + " of " : "") +
                       "this robot, scene and the newest synergies; run: " + grasp_command(world, arm));
    }
    add_grasps(query, std::move(grasps));
  }
  query.synergies = std::move(synergies.value);
  return query;
}

Goal goal_of(const Query& query, const robot::RobotModel& robot, const std::vector<ArmGoal>& parts) {
  Goal goal;
  goal.root.q.resize(robot.dof());
  goal.q_grasp.resize(robot.dof());
  std::vector<SynergyBox> boxes;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Grasp& grasp = query.grasps[parts[i].grasp].value;
    const ArmSolution& solution = grasp.arm_solutions[parts[i].solution];
    place(robot.arms()[i], solution.q_pregrasp, grasp.q_pregrasp, goal.root.q);
    place(robot.arms()[i], solution.q_grasp, grasp.q_grasp, goal.q_grasp);
    boxes.push_back(group_named(query.synergies, grasp.group).box);
    goal.grasps.push_back(parts[i].grasp);
  }
  goal.root.box = analysis::product_box(boxes);
  return goal;
}

}  // namespace opponens::cli
