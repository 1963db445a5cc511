// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/motion_request.hpp"

#include <algorithm>
#include <set>

#include "core/require.hpp"
#include "robot/joint_state_file.hpp"

namespace opponens::robot {

namespace {

bool holds_something(const std::optional<YamlValue>& value) {
  if (!value) return false;
  return value->is_sequence() ? !value->items().empty() : value->is_map() && !value->entries().empty();
}

/// Refuses a joint that is named twice: it is open which position counts.
void require_distinct(const std::vector<std::string>& names, const YamlValue& where) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) where.fail("joint '" + name + "' occurs twice");
  }
}

JointState read_goal(const YamlValue& goal, MotionRequest& request) {
  goal.allow_keys(
      {"name", "joint_constraints", "position_constraints", "orientation_constraints", "visibility_constraints"});
  for (const char* key : {"position_constraints", "orientation_constraints", "visibility_constraints"}) {
    if (holds_something(goal.find(key))) request.notes.push_back(std::string(key) + " of a goal: ignored");
  }
  JointState state;
  const auto constraints = goal.find("joint_constraints");
  if (!constraints || constraints->items().empty())
    goal.fail("expected joint_constraints: goals are joint positions here");
  std::vector<double> positions;
  for (const YamlValue& constraint : constraints->items()) {
    constraint.allow_keys({"joint_name", "position", "tolerance_above", "tolerance_below", "weight"});
    state.names.push_back(constraint.at("joint_name").text());
    positions.push_back(constraint.at("position").number());
  }
  require_distinct(state.names, *constraints);
  state.positions = Eigen::Map<const Eigen::VectorXd>(positions.data(), static_cast<Eigen::Index>(positions.size()));
  return state;
}

}  // namespace

JointState read_robot_state(const YamlValue& state, std::vector<std::string>& notes) {
  state.allow_keys({"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"});
  if (const auto attached = state.find("attached_collision_objects"); attached && holds_something(attached)) {
    notes.push_back(std::to_string(attached->items().size()) + " attached objects: ignored");
  }
  if (const auto floating = state.find("multi_dof_joint_state")) {
    const auto names = floating->find("joint_names");
    if (holds_something(names)) notes.push_back("multi_dof_joint_state: ignored; robot_base places the robot");
  }
  JointState joints;
  const auto written = state.find("joint_state");
  if (!written) return joints;
  written->allow_keys({"header", "name", "position", "velocity", "effort"});
  joints.names = written->at("name").texts();
  joints.positions = written->at("position").numbers(static_cast<int>(joints.names.size()));
  require_distinct(joints.names, written->at("name"));
  return joints;
}

MotionRequest load_motion_request(const std::filesystem::path& request_yaml) {
  const YamlValue root = YamlValue::load(request_yaml);
  root.allow_keys({"workspace_parameters", "start_state", "goal_constraints", "path_constraints",
                   "trajectory_constraints", "reference_trajectories", "pipeline_id", "planner_id", "group_name",
                   "num_planning_attempts", "allowed_planning_time", "max_velocity_scaling_factor",
                   "max_acceleration_scaling_factor", "cartesian_speed_end_effector_link", "max_cartesian_speed"});
  MotionRequest request;
  request.name = request_yaml.stem().string();
  if (const auto group = root.find("group_name")) request.group = group->text();
  request.start = read_robot_state(root.at("start_state"), request.notes);
  const YamlValue goals = root.at("goal_constraints");
  for (const YamlValue& goal : goals.items()) request.goals.push_back(read_goal(goal, request));
  if (request.goals.empty()) goals.fail("expected at least one goal");
  for (const char* key : {"path_constraints", "trajectory_constraints"}) {
    if (holds_something(root.find(key))) request.notes.push_back(std::string(key) + ": ignored");
  }
  return request;
}

Completed complete(const RobotModel& robot, const JointState& state, const Eigen::VectorXd& fallback) {
  require(fallback.size() == robot.dof(), [&] {
    return "complete: the fallback has " + std::to_string(fallback.size()) + " entries, the robot " +
           std::to_string(robot.dof());
  });
  Completed result{fallback, {}, {}};
  const std::vector<std::string>& joints = robot.joint_names();
  std::set<std::string> given;
  for (std::size_t i = 0; i < state.names.size(); ++i) {
    const auto joint = std::find(joints.begin(), joints.end(), state.names[i]);
    if (joint == joints.end()) {
      result.unknown.push_back(state.names[i]);
      continue;
    }
    result.q[joint - joints.begin()] = state.positions[static_cast<Eigen::Index>(i)];
    given.insert(*joint);
  }
  for (const std::string& joint : joints) {
    if (given.count(joint) == 0) result.assumed.push_back(joint);
  }
  return result;
}

}  // namespace opponens::robot
