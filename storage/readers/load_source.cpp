// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <regex>
#include <set>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/source.hpp"
#include "storage/readers/yaml_section.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

/// A description is a page; more is a mistake, or an attempt to tie up the parser.
constexpr std::size_t kLongestDescription = 256 * 1024;
constexpr std::size_t kLongestExpression = 200;
constexpr std::size_t kMostColumns = 100000;

/// The sensors of a CyberGlove in the order of its data; 22 have no index abduction (it is the reference), 18 no
/// distal joints either.
std::vector<std::string> glove_channels(const std::string& glove) {
  std::vector<std::string> names = human_hand_channels();
  if (glove != "cyberglove_23") std::erase(names, "I_ABD");
  if (glove == "cyberglove_18") std::erase_if(names, [](const auto& name) { return name.ends_with("_DIP"); });
  return names;
}

std::vector<ChannelSource> built_in_channels(const Section& map) {
  const auto glove = map.choice<std::string>(
      "glove",
      {{"cyberglove_23", "cyberglove_23"}, {"cyberglove_22", "cyberglove_22"}, {"cyberglove_18", "cyberglove_18"}});
  const std::size_t first = map.count("first_column", kMostColumns);
  if (first == 0) map.fail("first_column", "the number of the column of the first sensor");
  const std::vector<std::string> names = glove_channels(glove);
  const std::vector<std::string> negative = map.texts("negative");
  for (const auto& name : negative) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      map.fail("negative", "a list of channels of this glove; '" + name + "' is none");
    }
  }
  std::vector<ChannelSource> channels;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool turned = std::find(negative.begin(), negative.end(), names[i]) != negative.end();
    channels.push_back({std::to_string(first + i), names[i], turned ? -1.0 : 1.0});
  }
  return channels;
}

ChannelSource read_channel(const Section& item, const SourceDescription& source) {
  ChannelSource channel{item.text("column"), item.text("joint", item.text("column")), item.sign("sign")};
  const std::string joint = item.has("joint") ? "joint" : "column";
  const std::vector<std::string>& known = human_hand_channels();
  const bool human = source.kind == RecordingKind::demonstration;
  if (human && std::find(known.begin(), known.end(), channel.joint) == known.end()) {
    item.fail_as("unknown channel: joint", joint, "one of " + joined(known));
  }
  if (item.has("raw")) channel.raw = item.pair("raw");
  if (item.has("rad")) channel.rad = item.pair("rad");
  const bool raw = source.unit == AngleUnit::raw;
  if (raw != channel.rad.has_value())
    item.fail("rad", raw ? "two angles: the unit is raw" : "no such key: unit is not raw");
  if (channel.raw && !raw) item.fail("raw", "no such key: unit is not raw");
  return channel;
}

void read_channels(const Section& root, SourceDescription& source) {
  if (root.is_map("channels")) {
    source.channels = built_in_channels(root.inside("channels", {"glove", "first_column", "negative"}));
    if (source.unit == AngleUnit::raw) root.fail("channels", "a list with the angles of each: the unit is raw");
    return;
  }
  std::set<std::string> columns;
  std::set<std::string> joints;
  for (const auto& item : root.items("channels", {"column", "joint", "sign", "raw", "rad"})) {
    ChannelSource channel = read_channel(item, source);
    if (!columns.insert(channel.column).second) item.fail_as("column", "column", "each column once");
    if (!joints.insert(channel.joint).second) {
      item.fail_as("joint", item.has("joint") ? "joint" : "column", "each joint once");
    }
    source.channels.push_back(std::move(channel));
  }
  if (source.channels.empty()) root.fail("channels", "a list of {column, joint, sign}");
}

YAML::Node parse(const std::string& text, const std::filesystem::path& file) {
  if (text.size() > kLongestDescription) throw InputError(file.string() + ": larger than 256 kB: not a description");
  if (!is_utf8(text)) throw InputError(file.string() + ": not UTF-8 text: expected a YAML description");
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(file.string() + ":" + std::to_string(error.mark.line + 1) + ": not YAML: " + error.msg);
  }
}

void read_recordings(const Section& root, SourceDescription& source) {
  const Section section = root.inside("recordings", {"index", "folder", "file_column", "files", "parts"});
  RecordingFiles& files = source.recordings;
  files.parts = section.texts("parts");
  if (!section.has("files")) {
    files.index = section.text("index");
    files.folder = section.text("folder", "");
    files.file_column = section.text("file_column");
    if (section.has("parts")) section.fail("parts", "the key 'files', whose groups the parts name");
    return;
  }
  for (const auto* other : {"index", "folder", "file_column"}) {
    if (section.has(other)) section.fail(other, "no such key beside 'files'");
  }
  files.expression = section.text("files");
  if (files.expression.size() > kLongestExpression) section.fail("files", "at most 200 characters");
  try {
    const std::regex expression(files.expression);
    if (expression.mark_count() != files.parts.size()) {
      section.fail("files", "as many groups as 'parts' has names (" + std::to_string(files.parts.size()) + ")");
    }
  } catch (const std::regex_error& error) {
    section.fail("files", std::string("a regular expression: ") + error.what());
  }
}

void read_cells(const Section& section, TableLayout& table) {
  for (const auto& item : section.items("cells", {"name", "values"})) {
    table.cells.push_back({item.text("name"), item.texts("values")});
    if (table.cells.back().values.empty()) item.fail("values", "a name for every cell");
  }
}

void read_table(const Section& root, SourceDescription& source) {
  if (!root.has("table")) return;
  const Section section =
      root.inside("table", {"format", "columns", "skip_lines", "transposed", "run_by", "variable", "cells", "group"});
  TableLayout& table = source.table;
  table.format = section.choice<TableFormat>("format", {{"csv", TableFormat::csv},
                                                        {"text", TableFormat::text},
                                                        {"matlab", TableFormat::matlab},
                                                        {"hdf5", TableFormat::hdf5}});
  const bool text = table.format == TableFormat::csv || table.format == TableFormat::text;
  const bool matlab = table.format == TableFormat::matlab;
  const auto only = [&](const char* key, bool allowed, const char* where) {
    if (section.has(key) && !allowed) section.fail(key, std::string("no such key but for ") + where);
  };
  only("columns", matlab || table.format == TableFormat::text, "the formats text and matlab");
  only("skip_lines", table.format == TableFormat::text, "the format text");
  only("transposed", text || matlab, "the formats csv, text and matlab");
  only("run_by", text, "the formats csv and text");
  only("variable", matlab, "the format matlab");
  only("cells", matlab, "the format matlab");
  only("group", table.format == TableFormat::hdf5, "the format hdf5");
  table.columns = section.count("columns", kMostColumns);
  if (table.format == TableFormat::text && table.columns == 0) section.fail("columns", "how many a line has");
  table.skip_lines = section.count("skip_lines", kMostColumns);
  table.transposed = section.flag("transposed");
  table.run_by = section.texts("run_by");
  if (table.transposed && !table.run_by.empty()) section.fail("run_by", "no such key beside 'transposed'");
  if (matlab) table.variable = section.text("variable");
  read_cells(section, table);
  table.group = section.text("group", "");
}

void read_time(const Section& root, SourceDescription& source) {
  if (!root.is_map("time")) {
    if (root.text("time") != "none") root.fail("time", "a mapping, or none");
    return;
  }
  const Section section = root.inside("time", {"column", "unit", "date", "rate", "variable", "file"});
  TimeSource& time = source.time;
  int kinds = 0;
  for (const auto* key : {"column", "date", "rate", "variable"}) kinds += section.has(key) ? 1 : 0;
  if (kinds != 1) root.fail("time", "one of time.column, time.date, time.rate, time.variable");
  if (section.has("column")) time.columns = {section.text("column")};
  if (section.has("date")) {
    time.columns = section.texts("date");
    if (time.columns.size() != 6) section.fail("date", "the columns of year, month, day, hour, minute, second");
  }
  if (section.has("rate")) time.rate = section.positive("rate");
  time.variable = section.text("variable", "");
  time.file = section.text("file", "");
  if (section.has("unit") && !section.has("column") && time.variable.empty()) {
    section.fail("unit", "no such key but beside 'column' or 'variable'");
  }
  time.unit = section.positive("unit", 1.0);
  if (!time.variable.empty() && source.table.format != TableFormat::matlab) {
    section.fail("variable", "no such key but for the format matlab");
  }
  if (!time.file.empty() && time.variable.empty()) section.fail("file", "no such key but beside 'variable'");
}

void read_unit(const Section& root, SourceDescription& source) {
  source.unit =
      root.choice<AngleUnit>("unit", {{"rad", AngleUnit::rad}, {"deg", AngleUnit::deg}, {"raw", AngleUnit::raw}});
  source.wrap = root.flag("wrap");
  if (!root.has("raw_range")) return;
  if (source.unit != AngleUnit::raw) root.fail("raw_range", "no such key: unit is not raw");
  if (root.is_map("raw_range")) {
    source.raw_range.observed_in = root.inside("raw_range", {"observed_in"}).text_map("observed_in");
    for (const auto& [label, value] : source.raw_range.observed_in) {
      if (!source.labels.contains(label) && !source.constants.contains(label)) {
        root.fail("raw_range", "labels of this source in observed_in; '" + label + "' is none");
      }
    }
  } else if (root.is_list("raw_range")) {
    source.raw_range.fixed = root.pair("raw_range");
  } else if (root.text("raw_range") != "observed") {
    root.fail("raw_range", "two counts, observed, or {observed_in: {LABEL: value}}");
  }
}

void read_labels(const Section& root, SourceDescription& source) {
  std::tie(source.labels, source.constants) = root.labels("labels");
  for (const auto* reserved : {"source", "calibration", "kind"}) {
    if (source.labels.contains(reserved) || source.constants.contains(reserved)) {
      root.fail("labels", "no label '" + std::string(reserved) + "': it is set by the reader");
    }
  }
}

void read_processing(const Section& root, SourceDescription& source) {
  const auto rules = {std::pair<std::string, ChannelRule>{"keep", ChannelRule::keep}, {"drop", ChannelRule::drop}};
  source.stuck = root.choice<ChannelRule>("stuck", rules);
  source.dependent = root.choice<ChannelRule>("dependent", rules);
  source.weight =
      root.choice<WeightRule>("weight", {{"samples", WeightRule::samples}, {"recording", WeightRule::recording}});
  source.split_where_time_goes_back = root.choice<bool>("split", {{"none", false}, {"where_time_goes_back", true}});
  if (root.has("resample")) source.resample_rate = root.inside("resample", {"rate"}).positive("rate");
  if (root.has("trim")) {
    const Section trim = root.inside("trim", {"speed", "window"});
    source.trim = TrimRule{trim.positive("speed"), trim.positive("window")};
  }
  for (const auto* key : {"resample", "trim", "split"}) {
    if (!source.time.present() && root.has(key)) root.fail(key, "no such key for postures: there is no time");
  }
  if (root.has("calibrate")) {
    const Section calibrate = root.inside("calibrate", {"method", "by"});
    if (source.kind == RecordingKind::hand_demonstration) root.fail("calibrate", "no such key: nothing is mapped");
    if (calibrate.text("method") != "range") calibrate.fail("method", "range");
    source.calibrate_by = calibrate.text("by");
    const std::string& by = *source.calibrate_by;
    if (!source.labels.contains(by) && !source.constants.contains(by)) {
      calibrate.fail("by", "a label that this source has");
    }
  }
}

void read_kind(const Section& root, SourceDescription& source) {
  source.kind = root.choice<RecordingKind>("kind", {{"demonstration", RecordingKind::demonstration},
                                                    {"hand_demonstration", RecordingKind::hand_demonstration}});
  const bool hand = source.kind == RecordingKind::hand_demonstration;
  if (hand != root.has("hand")) {
    root.fail("hand", hand ? "the hand.yaml of the robot hand" : "no such key but for kind: hand_demonstration");
  }
  source.hand = root.text("hand", "");
  source.origin = root.choice<Origin>("origin", {{"recorded", Origin::recorded}, {"simulated", Origin::simulated}});
}

}  // namespace

const std::vector<std::string>& human_hand_channels() {
  static const std::vector<std::string> names{
      "T_ROT", "T_MCP", "T_IP",  "T_ABD", "I_MCP", "I_PIP", "I_DIP", "I_ABD", "M_MCP",     "M_PIP",   "M_DIP", "M_ABD",
      "R_MCP", "R_PIP", "R_DIP", "R_ABD", "L_MCP", "L_PIP", "L_DIP", "L_ABD", "PALM_ARCH", "W_PITCH", "W_YAW"};
  return names;
}

SourceDescription parse_source(const std::string& text, const std::filesystem::path& yaml) {
  const Section root(
      parse(text, yaml), yaml, "",
      {"name",      "origin",   "kind",   "hand",  "recordings", "table", "labels", "time",     "unit", "wrap",
       "raw_range", "channels", "ignore", "stuck", "dependent",  "split", "weight", "resample", "trim", "calibrate"});
  SourceDescription source;
  source.name = root.text("name");
  read_kind(root, source);
  read_recordings(root, source);
  read_table(root, source);
  require_distinct_facts(root, source);
  read_labels(root, source);
  read_time(root, source);
  read_unit(root, source);
  read_channels(root, source);
  source.ignored_columns = root.texts("ignore");
  if (root.has("ignore") && source.table.format != TableFormat::csv) {
    root.fail("ignore", "no such key: only files with a header name their columns");
  }
  read_processing(root, source);
  return source;
}

SourceDescription load_source(const std::filesystem::path& yaml) { return parse_source(read_file(yaml), yaml); }

}  // namespace opponens::storage
