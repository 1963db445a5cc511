// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/read_urdf.hpp"
#include "robot/robot_model.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

/// What a robot.yaml says for all its arms, and its reader.
struct ArmSettings {
  LinkGeometry geometry = LinkGeometry::urdf_collision;
  MissingMeshes missing_meshes = MissingMeshes::refuse;
};

/// An arm with its hand, or alone, from the keys arm, hand, mount, without_geometry, weights, allowed_collisions and
/// srdf of a map: a robot.yaml with one arm, or an entry of `arms`.
RobotDescription load_arm(const YamlValue& file, const ArmSettings& settings);

}  // namespace opponens::robot
