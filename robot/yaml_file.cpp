// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/yaml_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include <yaml-cpp/yaml.h>

#include "core/require.hpp"
#include "robot/text_file.hpp"

namespace opponens::robot {

namespace {

std::string expand_environment(const YamlValue& value, const std::string& text) {
  std::string expanded;
  std::size_t position = 0;
  while (true) {
    const std::size_t open = text.find("${", position);
    if (open == std::string::npos) return expanded + text.substr(position);
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) value.fail("'" + text + "' has ${ without }");
    const std::string name = text.substr(open + 2, close - open - 2);
    const char* content = std::getenv(name.c_str());
    if (content == nullptr) value.fail("environment variable " + name + " is not set");
    expanded += text.substr(position, open - position) + content;
    position = close + 1;
  }
}

}  // namespace

Eigen::Isometry3d pose_from_xyz_rpy(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() =
      (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  X.translation() = xyz;
  return X;
}

YamlValue::YamlValue(std::shared_ptr<const std::filesystem::path> file, std::string field, const YAML::Node& node)
    : file_(std::move(file)), field_(std::move(field)), node_(std::make_shared<YAML::Node>(node)) {}

YamlValue YamlValue::load(const std::filesystem::path& file) {
  const std::string content = read_text_file(file, "a YAML file");
  try {
    return {std::make_shared<std::filesystem::path>(file), "", YAML::Load(content)};
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    throw InputError(file.string() + line + ": is not YAML: " + error.msg);
  }
}

bool YamlValue::is_sequence() const { return node_->IsSequence(); }
bool YamlValue::is_map() const { return node_->IsMap(); }
bool YamlValue::has(const std::string& key) const { return find(key).has_value(); }

YamlValue YamlValue::at(const std::string& key) const {
  std::optional<YamlValue> value = find(key);
  if (!value) fail("has no key '" + key + "'");
  return *value;
}

std::optional<YamlValue> YamlValue::find(const std::string& key) const {
  if (!node_->IsMap()) fail("expected a map");
  const YAML::Node child = static_cast<const YAML::Node&>(*node_)[key];
  if (!child.IsDefined()) return std::nullopt;
  return YamlValue(file_, field_.empty() ? key : field_ + "." + key, child);
}

std::vector<YamlValue> YamlValue::items() const {
  if (!node_->IsSequence()) fail("expected a list");
  std::vector<YamlValue> values;
  for (const YAML::Node& child : *node_) {
    values.push_back(YamlValue(file_, field_ + "[" + std::to_string(values.size()) + "]", child));
  }
  return values;
}

std::vector<std::pair<std::string, YamlValue>> YamlValue::entries() const {
  if (!node_->IsMap()) fail("expected a map");
  std::vector<std::pair<std::string, YamlValue>> values;
  std::set<std::string> seen;
  for (const auto& entry : *node_) {
    if (!entry.first.IsScalar()) fail("has a key that is not a text");
    const std::string key = entry.first.Scalar();
    values.emplace_back(key, YamlValue(file_, field_.empty() ? key : field_ + "." + key, entry.second));
    if (!seen.insert(key).second) values.back().second.fail("the key occurs twice");
  }
  return values;
}

std::string YamlValue::text() const {
  if (!node_->IsScalar()) fail("expected a text");
  return node_->Scalar();
}

double YamlValue::number() const {
  double value = 0.0;
  if (!node_->IsScalar() || !YAML::convert<double>::decode(*node_, value)) {
    fail("expected a number" + (node_->IsScalar() ? ", found '" + node_->Scalar() + "'" : std::string()));
  }
  if (!std::isfinite(value)) fail("expected a finite number, found '" + node_->Scalar() + "'");
  return value;
}

Eigen::VectorXd YamlValue::numbers(int count) const {
  const std::vector<YamlValue> values = items();
  if (count >= 0 && static_cast<int>(values.size()) != count) {
    fail("expected " + std::to_string(count) + " numbers, found " + std::to_string(values.size()));
  }
  Eigen::VectorXd result(static_cast<Eigen::Index>(values.size()));
  for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = values[static_cast<std::size_t>(i)].number();
  return result;
}

std::vector<std::string> YamlValue::texts() const {
  std::vector<std::string> result;
  for (const YamlValue& value : items()) result.push_back(value.text());
  return result;
}

Eigen::Isometry3d YamlValue::pose() const {
  const std::optional<YamlValue> xyz = find("xyz");
  const std::optional<YamlValue> rpy = find("rpy");
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  return pose_from_xyz_rpy(xyz ? Eigen::Vector3d(xyz->numbers(3)) : zero,
                           rpy ? Eigen::Vector3d(rpy->numbers(3)) : zero);
}

std::filesystem::path YamlValue::path() const {
  const std::filesystem::path written = expand_environment(*this, text());
  return written.is_absolute() ? written : file_->parent_path() / written;
}

void YamlValue::allow_keys(std::initializer_list<const char*> keys) const {
  for (const auto& [key, value] : entries()) {
    const bool known = std::any_of(keys.begin(), keys.end(), [&key = key](const char* name) { return key == name; });
    if (!known) value.fail("unknown key");
  }
}

void YamlValue::fail(const std::string& message) const {
  const YAML::Mark mark = node_->IsDefined() ? node_->Mark() : YAML::Mark::null_mark();
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  throw InputError(file_->string() + line + ": " + (field_.empty() ? "" : field_ + ": ") + message);
}

}  // namespace opponens::robot
