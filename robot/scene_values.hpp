// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: values that the scene files share.

#include <string>

#include <Eigen/Geometry>

#include "robot/yaml_file.hpp"

namespace opponens::robot {

double positive(const YamlValue& value);      ///< InputError unless a number above 0
std::string name_of(const YamlValue& value);  ///< InputError unless a text that is not empty

/// xyz (m) with rpy (rad, fixed axes) or quaternion (w, x, y, z), each optional.
Eigen::Isometry3d pose_of(const YamlValue& value);

/// Position [x, y, z] m and orientation [x, y, z, w] of a ROS message, each a list or a map {x, y, z(, w)}.
Eigen::Vector3d ros_vector(const YamlValue& value);
Eigen::Quaterniond ros_quaternion(const YamlValue& value);

/// Norms further from 1 than this are no rotation that somebody rounded: MotionBenchMaker writes 0.707.
inline constexpr double kQuaternionTolerance = 1e-2;

}  // namespace opponens::robot
