// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/source.hpp"

namespace opponens::storage {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

/// A YAML mapping whose keys must all be known, with errors that name file, line, key, value and expectation.
class Section {
 public:
  Section(const YAML::Node& node, std::filesystem::path file, std::string name, const std::vector<std::string>& keys)
      : node_(node), file_(std::move(file)), name_(std::move(name)) {
    if (!node_.IsMap()) fail(node_, name_.empty() ? "the document" : name_, "a mapping with the keys " + joined(keys));
    std::set<std::string> seen;
    for (const auto& entry : node_) {
      const std::string key = text_of(entry.first, "a key");
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        fail(entry.first, "key", name_.empty() ? "one of " + joined(keys) : "one of " + joined(keys) + " in " + name_);
      }
      if (!seen.insert(key).second) fail(entry.first, "key", "each key once");
    }
  }

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }

  YAML::Node at(const std::string& key) const {
    if (has(key)) return node_[key];
    throw_input(file_, line(node_), full(key), "", "a value (the key is missing)");
  }
  std::string text(const std::string& key) const { return text_of(at(key), full(key)); }
  std::string text(const std::string& key, const std::string& otherwise) const {
    return has(key) ? text(key) : otherwise;
  }
  double positive(const std::string& key) const {
    const double value = number(at(key), full(key), "a number above 0");
    if (!(value > 0.0)) fail(at(key), full(key), "a number above 0");
    return value;
  }
  double sign(const std::string& key) const {
    if (!has(key)) return 1.0;
    const double value = number(at(key), full(key), "1 or -1");
    if (std::abs(value) != 1.0) fail(at(key), full(key), "1 or -1");
    return value;
  }
  std::vector<std::string> texts(const std::string& key) const {
    if (!has(key)) return {};
    if (!at(key).IsSequence()) fail(at(key), full(key), "a list of names");
    std::vector<std::string> values;
    for (const auto& item : at(key)) values.push_back(text_of(item, full(key)));
    return values;
  }
  std::map<std::string, std::string> text_map(const std::string& key) const {
    std::map<std::string, std::string> values;
    if (!has(key)) return values;
    if (!at(key).IsMap()) fail(at(key), full(key), "a mapping of names to names");
    for (const auto& entry : at(key)) {
      if (!values.emplace(text_of(entry.first, full(key)), text_of(entry.second, full(key))).second) {
        fail(entry.first, full(key), "each name once");
      }
    }
    return values;
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& field, const std::string& expectation) const {
    std::string value = node.IsScalar() ? node.Scalar() : "";
    if (node.IsMap()) value = "a mapping";
    if (node.IsSequence()) value = "a list";
    throw_input(file_, line(node), field, value, expectation);
  }
  const std::filesystem::path& file() const { return file_; }

 private:
  static long line(const YAML::Node& node) { return node.Mark().line + 1; }
  std::string full(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }
  std::string text_of(const YAML::Node& node, const std::string& field) const {
    if (!node.IsScalar() || node.Scalar().empty()) fail(node, field, "a text");
    return node.Scalar();
  }
  double number(const YAML::Node& node, const std::string& field, const std::string& expectation) const {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
      fail(node, field, expectation);
    }
    return value;
  }

  YAML::Node node_;
  std::filesystem::path file_;
  std::string name_;
};

template <typename Enum>
Enum choice(const Section& section, const std::string& key, const std::vector<std::pair<std::string, Enum>>& options) {
  if (!section.has(key)) return options.front().second;
  const std::string text = section.text(key);
  std::vector<std::string> names;
  for (const auto& [name, value] : options) {
    if (name == text) return value;
    names.push_back(name);
  }
  section.fail(section.at(key), key, "one of " + joined(names));
}

std::vector<ChannelSource> read_channels(const Section& root) {
  const YAML::Node list = root.at("channels");
  if (!list.IsSequence() || list.size() == 0) root.fail(list, "channels", "a list of {column, joint, sign}");
  std::vector<ChannelSource> channels;
  std::set<std::string> columns;
  std::set<std::string> joints;
  const std::vector<std::string>& known = human_hand_channels();
  for (const auto& node : list) {
    const Section item(node, root.file(), "channels[" + std::to_string(channels.size()) + "]",
                       {"column", "joint", "sign"});
    ChannelSource channel{item.text("column"), item.text("joint", item.text("column")), item.sign("sign")};
    const YAML::Node joint = item.has("joint") ? item.at("joint") : item.at("column");
    if (std::find(known.begin(), known.end(), channel.joint) == known.end()) {
      item.fail(joint, "unknown channel: joint", "one of " + joined(known));
    }
    if (!columns.insert(channel.column).second) item.fail(item.at("column"), "column", "each column once");
    if (!joints.insert(channel.joint).second) item.fail(joint, "joint", "each joint once");
    channels.push_back(std::move(channel));
  }
  return channels;
}

YAML::Node parse(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ":" + std::to_string(error.mark.line + 1) + ": not YAML: " + error.msg);
  }
}

void read_recordings(const Section& root, SourceDescription& source) {
  const Section recordings(root.at("recordings"), root.file(), "recordings", {"index", "folder", "file_column"});
  source.index = recordings.text("index");
  source.folder = recordings.text("folder", "");
  source.file_column = recordings.text("file_column");
}

void read_processing(const Section& root, SourceDescription& source) {
  if (root.has("resample")) {
    source.resample_rate = Section(root.at("resample"), root.file(), "resample", {"rate"}).positive("rate");
  }
  if (root.has("trim")) {
    const Section trim(root.at("trim"), root.file(), "trim", {"speed", "window"});
    source.trim = TrimRule{trim.positive("speed"), trim.positive("window")};
  }
  if (root.has("calibrate")) {
    const Section calibrate(root.at("calibrate"), root.file(), "calibrate", {"method", "by"});
    if (calibrate.text("method") != "range") calibrate.fail(calibrate.at("method"), "calibrate.method", "range");
    source.calibrate_by = calibrate.text("by");
    if (!source.labels.contains(*source.calibrate_by)) {
      calibrate.fail(calibrate.at("by"), "calibrate.by", "a label that this source has");
    }
  }
}

}  // namespace

const std::vector<std::string>& human_hand_channels() {
  static const std::vector<std::string> names{
      "T_ROT", "T_MCP", "T_IP",  "T_ABD", "I_MCP", "I_PIP", "I_DIP", "I_ABD", "M_MCP",     "M_PIP",   "M_DIP", "M_ABD",
      "R_MCP", "R_PIP", "R_DIP", "R_ABD", "L_MCP", "L_PIP", "L_DIP", "L_ABD", "PALM_ARCH", "W_PITCH", "W_YAW"};
  return names;
}

SourceDescription load_source(const std::filesystem::path& yaml) {
  const Section root(parse(yaml), yaml, "",
                     {"name", "origin", "recordings", "labels", "time", "unit", "channels", "ignore", "resample",
                      "trim", "calibrate"});
  SourceDescription source;
  source.name = root.text("name");
  source.origin = choice<Origin>(root, "origin", {{"recorded", Origin::recorded}, {"simulated", Origin::simulated}});
  read_recordings(root, source);
  source.labels = root.text_map("labels");
  for (const auto* reserved : {"source", "calibration"}) {
    if (source.labels.contains(reserved))
      root.fail(root.at("labels"), "labels", "no label '" + std::string(reserved) + "': it is set by the reader");
  }
  source.time_column = Section(root.at("time"), yaml, "time", {"column"}).text("column");
  source.unit = choice<AngleUnit>(root, "unit", {{"rad", AngleUnit::rad}, {"deg", AngleUnit::deg}});
  source.channels = read_channels(root);
  source.ignored_columns = root.texts("ignore");
  read_processing(root, source);
  return source;
}

}  // namespace opponens::storage
