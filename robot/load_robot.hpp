// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "robot/read_urdf.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Reads a robot.yaml (arm URDF + hand.yaml + mount; docs/robot_files.md) with its URDFs and meshes.
/// Throws InputError naming file, element, value and what was expected.
/// group: of a file with several arms the arm that q drives, or "both" of two; empty: the file's default. The other arms
/// stand at their rest positions (drive_arms of robot/robot_arms.hpp chooses again without reading). missing: going on
/// without meshes that are not there lists them in the description.
RobotDescription load_robot(const std::filesystem::path& robot_yaml, const std::string& group = "",
                            MissingMeshes missing = MissingMeshes::refuse);

/// Reads a hand.yaml alone: the tree below the palm link, which becomes the root (frame H).
RobotDescription load_hand(const std::filesystem::path& hand_yaml);
RobotDescription load_hand(const std::filesystem::path& hand_yaml, MissingMeshes missing);
/// The same with another URDF in place of the one that the hand.yaml names.
RobotDescription load_hand(const std::filesystem::path& hand_yaml, const std::filesystem::path& urdf,
                           MissingMeshes missing = MissingMeshes::refuse);

/// A URDF alone, understood without any YAML: the palm is where the fingers branch (robot/hand_outline.hpp), the
/// joints above it that move are the arm's, those below the hand's. Where nothing branches, the tree is an arm and its
/// last link stands for the palm. Notes say what was guessed.
RobotDescription load_urdf(const std::filesystem::path& urdf, const UrdfSettings& settings);

/// The hand of a robot: the tree below its palm link, which becomes the root (frame H). Of a robot with several arms:
/// the hand of the one that q drives; its joints have the names of its hand.yaml, as the synergies of that hand do, its
/// links those of the robot, as contacts name them. Throws std::invalid_argument when q drives several arms.
RobotDescription hand_of(const RobotDescription& robot);

}  // namespace opponens::robot
