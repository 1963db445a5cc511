// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/export_table.hpp"

#include <array>
#include <cstdio>
#include <utility>

#include "cli/records.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "storage/codec.hpp"
#include "storage/posix_file.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kIndexColumns{"file", "id", "kind", "name"};

template <typename Derived>
void append_row(std::string& text, const std::string& first, const Eigen::DenseBase<Derived>& values) {
  text += first;
  for (const double value : values.derived().reshaped()) {
    text += ',';
    append_number(text, value);
  }
  text += '\n';
}

std::string header(const std::string& first, const std::vector<std::string>& names) {
  std::string text = first;
  for (const auto& name : names) text.append(",").append(cell(name));
  return text.append("\n");
}

std::string movement_table(const storage::Episode& episode) {
  std::string text = header("time_s", episode.joint_names);
  for (Eigen::Index i = 0; i < episode.q.rows(); ++i) {
    append_number(text, episode.time(i));
    append_row(text, "", episode.q.row(i));
  }
  return text;
}

/// One line a joint: its mean and its entry in every synergy; then the variance of each synergy and, as far as the box
/// has it, its half width.
std::string synergy_table(const std::vector<std::string>& joints, const SynergyGroup& group) {
  std::vector<std::string> columns{"mean"};
  for (Eigen::Index k = 0; k < group.basis.axes.cols(); ++k) columns.push_back("synergy_" + std::to_string(k + 1));
  std::string text = header("joint", columns);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    text.append(cell(joints[i])).append(",");
    append_number(text, group.basis.mean(row));
    append_row(text, "", group.basis.axes.row(row));
  }
  append_row(text, "variance,", group.basis.variance);
  append_row(text, "half_width,", group.box.half_width);
  return text;
}

}  // namespace

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
  return quoted.append("\"");
}

void append_number(std::string& text, double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.17g", value);
  text += digits.data();
}

storage::Episode episode_of(const std::string& id, const storage::Record& record) {
  storage::Episode episode{id, record.name, record.kind, {}, {}, {}, {}};
  if (record.kind != kPath) {
    Demonstration demonstration = storage::decode_demonstration(record);
    episode.labels = std::move(demonstration.labels);
    episode.labels["origin"] = text_field(record, "origin");
    episode.joint_names = std::move(demonstration.joint_names);
    episode.time = std::move(demonstration.time);
    episode.q = std::move(demonstration.q_h);
    return episode;
  }
  const PlanResult planned = storage::decode_plan_result(record);
  const auto motion = record.fields.find("motion");
  const auto times = record.fields.find("times");
  if (motion == record.fields.end() || times == record.fields.end()) {
    throw InputError("path '" + id + "' has no timed motion (status " + text_field(record, "status") + ")");
  }
  episode.joint_names = planned.path.joint_names;
  episode.q = std::get<Eigen::MatrixXd>(motion->second);
  episode.time = std::get<Eigen::VectorXd>(times->second);
  episode.labels["status"] = text_field(record, "status");
  return episode;
}

TableFolder::TableFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw InputError(folder_.string() + ": cannot make the folder: " + error.message());
  if (!fs::is_empty(folder_)) throw InputError(folder_.string() + ": the folder is not empty; name a new one");
}

void TableFolder::write(const std::string& file, const std::string& text, std::map<std::string, std::string> about) {
  storage::write_new_file(folder_ / file, std::as_bytes(std::span(text)), storage::Durable::no);
  about["file"] = file;
  for (const auto& [column, value] : about) columns_.insert(column);
  index_.push_back(std::move(about));
}

void TableFolder::add(const std::string& id, const storage::Record& record) {
  std::map<std::string, std::string> about{{"id", id}, {"kind", record.kind}, {"name", record.name}};
  if (record.kind != kSynergySet) {
    const storage::Episode episode = episode_of(id, record);
    for (const auto& [label, value] : episode.labels) about["label." + label] = value;
    write(short_id(id) + ".csv", movement_table(episode), std::move(about));
    return;
  }
  const SynergySet set = storage::decode_synergy_set(record);
  const std::vector<const SynergyGroup*> groups = groups_in_order(set);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i]->basis.mean.size() == 0) continue;  // a set without phases has no pre-grasp group
    about["label.group"] = groups[i]->name;
    about["label.phase"] = groups[i]->phase;
    write(short_id(id) + "_" + std::to_string(i) + ".csv", synergy_table(set.joint_names, *groups[i]), about);
  }
}

void TableFolder::finish() {
  for (const char* column : kIndexColumns) columns_.erase(column);
  std::string text = "file,id,kind,name";
  for (const auto& column : columns_) text.append(",").append(cell(column.substr(column.find('.') + 1)));
  text += "\n";
  for (auto& about : index_) {
    std::string line;
    for (const char* column : kIndexColumns) line.append(line.empty() ? "" : ",").append(cell(about[column]));
    for (const auto& column : columns_) line.append(",").append(cell(about[column]));
    text.append(line).append("\n");
  }
  storage::write_new_file(folder_ / "index.csv", std::as_bytes(std::span(text)), storage::Durable::no);
}

}  // namespace opponens::cli
