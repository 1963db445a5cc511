// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "motion/time_optimal.hpp"
#include "storage/record.hpp"

namespace opponens::cli {

struct NamedTrajectory {
  std::vector<std::string> joint_names;
  motion::Trajectory trajectory;
};

/// The timed motion of a stored path: at its knots, or every `period` seconds (and at its end) when that is not 0.
/// Throws InputError when the path has no rates: it was stored before paths had any, or no plan was found.
NamedTrajectory trajectory_of(const std::string& id, const storage::Record& record, double period);

/// ROS 2 trajectory_msgs/msg/JointTrajectory: header{stamp{sec, nanosec}, frame_id}, joint_names[],
/// points[]{positions[], velocities[], accelerations[], effort[], time_from_start{sec, nanosec}}. A number always has a
/// point, since YAML 1.1 takes 1e-5 for a string. Of points within the same nanosecond the last stays.
std::string joint_trajectory_json(const NamedTrajectory& trajectory);
std::string joint_trajectory_yaml(const NamedTrajectory& trajectory);

/// time_s, then each joint's position, then "JOINT velocity" and "JOINT acceleration" of each.
std::string trajectory_csv(const NamedTrajectory& trajectory);

}  // namespace opponens::cli
