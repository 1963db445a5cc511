// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "robot/read_urdf.hpp"
#include "robot/robot_model.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

/// An arm with its hand from the keys arm, hand, mount, without_geometry, weights and allowed_collisions of a map: a
/// robot.yaml with one arm, or an entry of `arms`.
RobotDescription load_arm(const YamlValue& file, LinkGeometry geometry);

/// A robot.yaml with the key `arms`. group: the arm that q drives, or "both"; empty: the file's default.
RobotDescription load_arms(const YamlValue& file, const std::string& group);

}  // namespace opponens::robot
