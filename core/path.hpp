// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace opponens {

/// A named part of the configuration q = [q_a; q_h].
struct PlanningGroup {
  std::string name;
  std::vector<std::string> joint_names;
  int first = 0;  ///< index of its first joint in q
  int count = 0;
};

struct JointPath {
  std::vector<std::string> joint_names;  ///< [d]
  Eigen::MatrixXd waypoints;             ///< [N x d] rad, row = configuration
};

enum class PlanStatus {
  solved,
  no_goals,  ///< no goal was given, or none is collision-free
  start_in_collision,
  start_out_of_limits,
  iteration_limit,
  check_limit,
  time_limit,
  interrupted,
};

/// In the order of the enumerators; what stored objects and documents call them.
inline constexpr std::array<std::string_view, 8> kPlanStatusNames{
    "solved",          "no_goals",    "start_in_collision", "start_out_of_limits",
    "iteration_limit", "check_limit", "time_limit",         "interrupted"};

inline std::string status_name(PlanStatus status) {
  return std::string(kPlanStatusNames[static_cast<std::size_t>(status)]);
}

struct PlanResult {
  PlanStatus status = PlanStatus::no_goals;
  JointPath path;                     ///< empty unless solved; ends at a pre-grasp, before the closing segment
  int bridge_row = -1;                ///< the waypoint where start and goal tree met; -1 unless solved
  int goal = -1;                      ///< index of the goal that was reached
  std::int64_t iterations = 0;        ///< passes of Algorithm 2's loop
  std::int64_t extends = 0;           ///< calls of SYNEXTEND
  std::int64_t extends_grown = 0;     ///< those that added a vertex
  std::int64_t collision_checks = 0;  ///< configurations evaluated
  double length = 0.0;                ///< rad, sum of sqrt(sum_j w_j dq_j^2)
  double length_l1 = 0.0;             ///< rad, sum of w_j |dq_j|
  std::string detail;                 ///< a sentence for a person when not solved
};

}  // namespace opponens
