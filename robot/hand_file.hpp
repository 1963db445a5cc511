// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/read_urdf.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

/// A name in a YAML file, kept with its place for messages.
struct NamedValue {
  std::string name;
  YamlValue where;
};

struct NamedPoint {
  SurfacePoint point;  ///< link index not yet known
  NamedValue link;
};

/// The content of a hand.yaml, before its URDF is read.
struct HandFile {
  YamlValue urdf;  ///< its path may name an environment variable that is not set where another URDF is used
  UrdfSettings urdf_settings;
  NamedValue palm_link;
  std::vector<NamedValue> without_geometry;  ///< links; their names are in urdf_settings too
  std::vector<NamedValue> joints;
  std::vector<NamedPoint> tips;
  std::vector<NamedPoint> contact_points;
  std::vector<std::pair<NamedValue, NamedValue>> allowed_collisions;
  std::optional<std::filesystem::path> srdf;
  std::optional<YamlValue> mapping;
};

/// Throws InputError naming file, line and field.
HandFile read_hand_file(const std::filesystem::path& hand_yaml);

/// Parts that hand.yaml and robot.yaml share.
PackagePaths read_packages(const YamlValue& file);
LinkGeometry read_link_geometry(const YamlValue& file);
std::optional<std::filesystem::path> read_srdf_path(const YamlValue& file);
std::vector<NamedValue> read_names(const YamlValue& list);
/// The links of key without_geometry, whose names join the settings.
std::vector<NamedValue> read_without_geometry(const YamlValue& file, UrdfSettings& settings);
std::vector<std::pair<NamedValue, NamedValue>> read_pairs(const YamlValue& file);

}  // namespace opponens::robot
