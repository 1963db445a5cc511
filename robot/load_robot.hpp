// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Reads a robot.yaml (arm URDF + hand.yaml + mount; docs/robot_files.md) with its URDFs and meshes.
/// Throws InputError naming file, element, value and what was expected.
RobotDescription load_robot(const std::filesystem::path& robot_yaml);

/// Reads a hand.yaml alone: the tree below the palm link, which becomes the root (frame H).
RobotDescription load_hand(const std::filesystem::path& hand_yaml);
/// The same with another URDF in place of the one that the hand.yaml names.
RobotDescription load_hand(const std::filesystem::path& hand_yaml, const std::filesystem::path& urdf);

/// The hand of a robot: the tree below its palm link, which becomes the root (frame H).
RobotDescription hand_of(const RobotDescription& robot);

}  // namespace opponens::robot
