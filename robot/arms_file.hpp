// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "robot/read_urdf.hpp"
#include "robot/robot_model.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

/// A robot.yaml with the key `arms`. group: the arm that q drives, or "both"; empty: the file's default.
RobotDescription load_arms(const YamlValue& file, const std::string& group, MissingMeshes missing);

}  // namespace opponens::robot
