// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace YAML {
class Node;
}

namespace opponens::robot {

/// A value in a YAML file that knows where it stands, so that every complaint names file, line and field.
class YamlValue {
 public:
  /// Parses a file; InputError when it cannot be read or is not YAML.
  static YamlValue load(const std::filesystem::path& file);

  bool has(const std::string& key) const;
  bool is_sequence() const;
  bool is_map() const;

  YamlValue at(const std::string& key) const;  ///< InputError when absent
  std::optional<YamlValue> find(const std::string& key) const;
  std::vector<YamlValue> items() const;  ///< InputError unless a sequence
  /// In the file's order; InputError unless a map, or when a key occurs twice: YAML leaves it open which one counts.
  std::vector<std::pair<std::string, YamlValue>> entries() const;

  std::string text() const;                  ///< InputError unless a scalar
  double number() const;                     ///< InputError unless a finite number
  Eigen::VectorXd numbers(int count) const;  ///< sequence of that many finite numbers; count < 0: any
  std::vector<std::string> texts() const;
  Eigen::Isometry3d pose() const;  ///< from the keys xyz (m) and rpy (rad, fixed axes) of a map, both optional

  /// Environment variables ${NAME} expanded; a relative path is relative to the YAML file.
  std::filesystem::path path() const;

  /// InputError when the map has a key that is not listed, or one twice: a mistyped option must not be ignored.
  void allow_keys(std::initializer_list<const char*> keys) const;

  /// Throws InputError "file:line: field: message".
  [[noreturn]] void fail(const std::string& message) const;

  const std::filesystem::path& file() const { return *file_; }

 private:
  YamlValue(std::shared_ptr<const std::filesystem::path> file, std::string field, const YAML::Node& node);

  std::shared_ptr<const std::filesystem::path> file_;
  std::string field_;
  std::shared_ptr<const YAML::Node> node_;
};

/// Rotation Rz(yaw) Ry(pitch) Rx(roll) and translation, as URDF writes a pose.
Eigen::Isometry3d pose_from_xyz_rpy(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy);

}  // namespace opponens::robot
