// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/hand_file.hpp"

#include <set>

namespace opponens::robot {

namespace {

NamedPoint read_point(const YamlValue& value) {
  value.allow_keys({"name", "finger", "link", "point", "normal"});
  const YamlValue link = value.at("link");
  NamedPoint point{{}, {link.text(), link}};
  point.point.finger = value.at("finger").text();
  point.point.name = value.has("name") ? value.at("name").text() : point.point.finger;
  point.point.p_L = value.at("point").numbers(3);
  const Eigen::Vector3d normal = value.at("normal").numbers(3);
  if (normal.norm() < 1e-9) value.at("normal").fail("must not be zero");
  point.point.n_L = normal.normalized();
  return point;
}

std::vector<NamedPoint> read_points(const YamlValue& file, const std::string& key) {
  std::vector<NamedPoint> points;
  std::set<std::string> names;
  const std::optional<YamlValue> list = file.find(key);
  if (!list) return points;
  for (const YamlValue& value : list->items()) {
    points.push_back(read_point(value));
    if (!names.insert(points.back().point.name).second) value.fail("name '" + points.back().point.name + "' repeats");
  }
  return points;
}

}  // namespace

PackagePaths read_packages(const YamlValue& file) {
  PackagePaths paths;
  const std::optional<YamlValue> packages = file.find("packages");
  if (!packages) return paths;
  if (packages->is_sequence()) {
    for (const YamlValue& root : packages->items()) paths.roots.push_back(root.path());
  } else {
    for (const auto& [name, directory] : packages->entries()) paths.directories[name] = directory.path();
  }
  return paths;
}

LinkGeometry read_link_geometry(const YamlValue& file) {
  const std::optional<YamlValue> value = file.find("collision");
  if (!value || value->text() == "urdf") return LinkGeometry::urdf_collision;
  if (value->text() == "visual") return LinkGeometry::visual;
  value->fail("expected urdf or visual, found '" + value->text() + "'");
}

std::optional<std::filesystem::path> read_srdf_path(const YamlValue& file) {
  const std::optional<YamlValue> value = file.find("srdf");
  return value ? std::optional(value->path()) : std::nullopt;
}

std::vector<NamedValue> read_names(const YamlValue& list) {
  std::vector<NamedValue> names;
  std::set<std::string> seen;
  for (const YamlValue& value : list.items()) {
    names.push_back({value.text(), value});
    if (!seen.insert(names.back().name).second) value.fail("'" + names.back().name + "' repeats");
  }
  return names;
}

std::vector<std::pair<NamedValue, NamedValue>> read_pairs(const YamlValue& file) {
  std::vector<std::pair<NamedValue, NamedValue>> pairs;
  const std::optional<YamlValue> list = file.find("allowed_collisions");
  if (!list) return pairs;
  for (const YamlValue& value : list->items()) {
    const std::vector<NamedValue> names = read_names(value);
    if (names.size() != 2) value.fail("expected two link names");
    pairs.emplace_back(names[0], names[1]);
  }
  return pairs;
}

std::vector<NamedValue> read_without_geometry(const YamlValue& file, UrdfSettings& settings) {
  const std::optional<YamlValue> list = file.find("without_geometry");
  std::vector<NamedValue> links = list ? read_names(*list) : std::vector<NamedValue>();
  for (const NamedValue& link : links) settings.without_geometry.insert(link.name);
  return links;
}

HandFile read_hand_file(const std::filesystem::path& hand_yaml) {
  const YamlValue file = YamlValue::load(hand_yaml);
  file.allow_keys({"urdf", "packages", "collision", "without_geometry", "palm_link", "joints", "tips", "contact_points",
                   "mapping", "allowed_collisions", "srdf"});
  const YamlValue palm = file.at("palm_link");
  HandFile hand{.urdf = file.at("urdf"),
                .urdf_settings = {},
                .palm_link = {palm.text(), palm},
                .without_geometry = {},
                .joints = {},
                .tips = {},
                .contact_points = {},
                .allowed_collisions = {},
                .srdf = read_srdf_path(file),
                .mapping = file.find("mapping")};
  hand.urdf_settings.packages = read_packages(file);
  hand.urdf_settings.geometry = read_link_geometry(file);
  hand.without_geometry = read_without_geometry(file, hand.urdf_settings);
  hand.joints = read_names(file.at("joints"));
  if (hand.joints.empty()) file.at("joints").fail("names no joint");
  hand.tips = read_points(file, "tips");
  hand.contact_points = read_points(file, "contact_points");
  hand.allowed_collisions = read_pairs(file);
  return hand;
}

}  // namespace opponens::robot
