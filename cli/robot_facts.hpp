// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "robot/propose_contacts.hpp"
#include "robot/read_urdf.hpp"
#include "robot/robot_model.hpp"
#include "robot/self_collision.hpp"

namespace opponens::cli {

enum class RobotFileKind { robot_yaml, hand_yaml, urdf };

/// A robot as `opponens robot` loads it: going on without missing meshes.
struct LoadedRobot {
  RobotFileKind kind;
  std::filesystem::path file;
  robot::UrdfSettings settings;  ///< how the URDF was read; of a URDF alone
  robot::RobotModel model;
};

/// Loads whichever of the three the file is. packages: folders searched for package://NAME; only with a URDF (the YAML
/// files name their own). The visual shapes stand in where a URDF alone has no collision shapes. Throws InputError.
LoadedRobot load_any_robot(const std::string& file, const std::vector<std::filesystem::path>& packages);

/// What a link's surface is made of.
struct LinkSurface {
  int boxes = 0, spheres = 0, cylinders = 0, meshes = 0;
  long long triangles = 0;        ///< of the meshes
  std::vector<std::string> open;  ///< file names of meshes that are not closed
};
LinkSurface surface_of(const robot::Link& link);

/// Everything that is said about a robot.
struct RobotFacts {
  LoadedRobot robot;
  std::uint64_t seed = 1;
  std::optional<robot::SelfCollisionSamples> samples{};  ///< none drawn with --samples 0
  robot::AllowedSuggestion suggestion{};
  std::optional<robot::ContactProposal> proposal{};
};

/// "revolute", ...
std::string name_of(robot::JointType type);
/// Names of the two links of a pair.
std::pair<std::string, std::string> names_of(const robot::RobotModel& model, const robot::LinkPairHits& pair);

Json robot_json(const RobotFacts& facts);
std::vector<std::string> robot_lines(const RobotFacts& facts);

}  // namespace opponens::cli
