// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/yaml_section.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "storage/readers/csv.hpp"

namespace opponens::storage {
namespace {

long line(const YAML::Node& node) { return node.Mark().line + 1; }

}  // namespace

std::string joined(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

Section::Section(const YAML::Node& node, std::filesystem::path file, std::string name,
                 const std::vector<std::string>& keys)
    : node_(std::make_shared<const YAML::Node>(node)), file_(std::move(file)), name_(std::move(name)) {
  if (!node_->IsMap()) {
    fail_node(*node_, name_.empty() ? "the document" : name_, "a mapping with the keys " + joined(keys));
  }
  std::set<std::string> seen;
  for (const auto& entry : *node_) {
    const std::string key = text_of(entry.first, "a key");
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      fail_node(entry.first, "key", "one of " + joined(keys) + (name_.empty() ? "" : " in " + name_));
    }
    if (!seen.insert(key).second) fail_node(entry.first, "key", "each key once");
  }
}

bool Section::has(const std::string& key) const { return static_cast<bool>((*node_)[key]); }

bool Section::is_map(const std::string& key) const { return has(key) && at(key).IsMap(); }

bool Section::is_list(const std::string& key) const { return has(key) && at(key).IsSequence(); }

YAML::Node Section::at(const std::string& key) const {
  if (has(key)) return (*node_)[key];
  throw_input(file_, line(*node_), full(key), "", "a value (the key is missing)");
}

Section Section::inside(const std::string& key, const std::vector<std::string>& keys) const {
  return {at(key), file_, full(key), keys};
}

std::vector<Section> Section::items(const std::string& key, const std::vector<std::string>& keys) const {
  std::vector<Section> sections;
  if (!has(key)) return sections;
  if (!at(key).IsSequence() || at(key).size() == 0) fail(key, "a list of {" + joined(keys) + "}");
  for (const auto& node : at(key)) {
    sections.push_back(Section(node, file_, full(key) + "[" + std::to_string(sections.size()) + "]", keys));
  }
  return sections;
}

std::string Section::text(const std::string& key) const { return text_of(at(key), full(key)); }

std::string Section::text(const std::string& key, const std::string& otherwise) const {
  return has(key) ? text(key) : otherwise;
}

double Section::positive(const std::string& key) const {
  const double value = number(at(key), full(key), "a number above 0");
  if (!(value > 0.0)) fail(key, "a number above 0");
  return value;
}

double Section::positive(const std::string& key, double otherwise) const {
  return has(key) ? positive(key) : otherwise;
}

std::size_t Section::count(const std::string& key, std::size_t largest) const {
  if (!has(key)) return 0;
  const std::string expected = "a whole number from 1 to " + std::to_string(largest);
  const double value = number(at(key), full(key), expected);
  if (!(value >= 1.0) || value > static_cast<double>(largest) || value != std::floor(value)) fail(key, expected);
  return static_cast<std::size_t>(value);
}

double Section::sign(const std::string& key) const {
  if (!has(key)) return 1.0;
  const double value = number(at(key), full(key), "1 or -1");
  if (std::abs(value) != 1.0) fail(key, "1 or -1");
  return value;
}

bool Section::flag(const std::string& key) const { return choice<bool>(key, {{"false", false}, {"true", true}}); }

Pair Section::pair(const std::string& key) const {
  const std::string expected = "a list of two different numbers";
  const YAML::Node list = at(key);
  if (!list.IsSequence() || list.size() != 2) fail(key, expected);
  const Pair values{number(list[0], full(key), expected), number(list[1], full(key), expected)};
  if (values[0] == values[1]) fail_node(list[1], full(key), expected);
  return values;
}

std::vector<std::string> Section::texts(const std::string& key) const {
  if (!has(key)) return {};
  if (!at(key).IsSequence()) fail(key, "a list of names");
  std::vector<std::string> values;
  for (const auto& item : at(key)) values.push_back(text_of(item, full(key)));
  return values;
}

std::map<std::string, std::string> Section::text_map(const std::string& key) const {
  std::map<std::string, std::string> values;
  if (!has(key)) return values;
  if (!at(key).IsMap()) fail(key, "a mapping of names to names");
  for (const auto& entry : at(key)) {
    if (!values.emplace(text_of(entry.first, full(key)), text_of(entry.second, full(key))).second) {
      fail_node(entry.first, full(key), "each name once");
    }
  }
  return values;
}

std::pair<std::map<std::string, std::string>, std::map<std::string, std::string>> Section::labels(
    const std::string& key) const {
  std::pair<std::map<std::string, std::string>, std::map<std::string, std::string>> found;
  if (!has(key)) return found;
  if (!at(key).IsMap()) fail(key, "a mapping of labels to where their values come from");
  for (const auto& entry : at(key)) {
    const std::string name = text_of(entry.first, full(key));
    const bool constant = entry.second.IsMap();
    if (found.first.contains(name) || found.second.contains(name)) {
      fail_node(entry.first, full(key), "each name once");
    }
    if (constant) {
      found.second[name] = Section(entry.second, file_, full(key) + "." + name, {"constant"}).text("constant");
    } else {
      found.first[name] = text_of(entry.second, full(key));
    }
  }
  return found;
}

void Section::fail(const std::string& key, const std::string& expectation) const {
  fail_as(full(key), key, expectation);
}

void Section::fail_as(const std::string& field, const std::string& key, const std::string& expectation) const {
  fail_node(has(key) ? at(key) : *node_, field, expectation);
}

void Section::fail_node(const YAML::Node& node, const std::string& field, const std::string& expectation) const {
  std::string value = node.IsScalar() ? node.Scalar() : "";
  if (node.IsMap()) value = "a mapping";
  if (node.IsSequence()) value = "a list";
  throw_input(file_, line(node), field, value, expectation);
}

std::string Section::text_of(const YAML::Node& node, const std::string& field) const {
  if (!node.IsScalar() || node.Scalar().empty()) fail_node(node, field, "a text");
  return node.Scalar();
}

double Section::number(const YAML::Node& node, const std::string& field, const std::string& expectation) const {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    fail_node(node, field, expectation);
  }
  return value;
}

void require_distinct_facts(const Section& root, const SourceDescription& source) {
  std::set<std::string> seen{"run", "group", "trial"};
  std::vector<std::string> names = source.recordings.parts;
  for (const auto& cells : source.table.cells) names.push_back(cells.name);
  names.insert(names.end(), source.table.run_by.begin(), source.table.run_by.end());
  for (const auto& name : names) {
    if (seen.insert(name).second) continue;
    const bool part = std::count(source.recordings.parts.begin(), source.recordings.parts.end(), name) > 0;
    root.fail(part ? "recordings" : "table",
              "each name of parts, cells and run_by once, and none of run, group, trial; "
              "not '" +
                  name + "'");
  }
}

}  // namespace opponens::storage
