// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/output.hpp"

#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "core/require.hpp"

namespace opponens::table2 {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string text_of(const std::optional<double>& value) { return value ? text_of(*value) : ""; }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

Json json(const std::optional<Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", estimate->value}, {"interval", {estimate->low, estimate->high}}};
}

Json json(const Column& column) {
  if (column.count == 0) return nullptr;
  return {{"count", column.count}, {"median", json(column.median)}, {"mean", json(column.mean)}};
}

Json json(const Summary& row) {
  return {{"planner", row.planner},
          {"range_rad", row.range},
          {"runs", row.runs},
          {"solved", row.solved},
          {"verified", row.verified},
          {"verified_of", row.verified_of},
          {"groups_reached", row.grasp_groups},
          {"cpu_ms", json(row.cpu_ms)},
          {"cpu_ms_quantile_99", row.cpu_ms_99},
          {"iterations", json(row.iterations)},
          {"collision_checks", json(row.checks)},
          {"collision_checks_with_confirmation", json(row.all_checks)},
          {"valid_segments_percent", json(row.valid_percent)},
          {"length_rad", json(row.length)},
          {"length_l1_rad", json(row.length_l1)},
          {"arm_length_rad", json(row.arm_length)},
          {"hand_length_rad", json(row.hand_length)},
          {"human_likeness", json(row.likeness)},
          {"planning_time_over_path_check_time", json(row.time_ratio)}};
}

Json json(const Comparison& one) {
  return {{"planner", one.planner},
          {"baseline", one.baseline},
          {"pairs", one.pairs},
          {"solved_pairs", one.solved_pairs},
          {"checks_ratio_geometric", json(one.checks_ratio)},
          {"checks_ratio_of_means", json(one.checks_mean_ratio)},
          {"checks_with_confirmation_ratio_geometric", json(one.all_checks_ratio)},
          {"cpu_ratio_geometric", json(one.cpu_ratio)},
          {"length_difference_rad", json(one.length_difference)},
          {"length_ratio_geometric", json(one.length_ratio)},
          {"length_l1_ratio_geometric", json(one.length_l1_ratio)},
          {"human_likeness_difference", json(one.likeness_difference)}};
}

Json json(const RunSettings& settings) {
  return {{"first_seed", settings.first_seed},
          {"seeds", settings.seeds},
          {"budget_checks", settings.budget},
          {"base_shift_m", settings.jitter.shift},
          {"base_turn_rad", settings.jitter.turn}};
}

template <typename T>
Json list(const std::vector<T>& values) {
  Json result = Json::array();
  for (const T& value : values) result.push_back(json(value));
  return result;
}

}  // namespace

std::string csv_of(const std::vector<Record>& records) {
  std::string text =
      "planner,range_rad,seed,solved,status,goals,group,cpu_s,iterations,checks,confirm_checks,valid_segments,length_"
      "rad,"
      "length_l1_rad,arm_length_rad,hand_length_rad,human_likeness,path_check_s,verified,clearance_m,reason\n";
  for (const Record& r : records) {
    text += quoted(r.planner) + "," + text_of(r.range) + "," + std::to_string(r.seed) + "," + (r.solved ? "1" : "0") +
            "," + r.status + "," + std::to_string(r.goals) + "," + quoted(r.group) + "," + text_of(r.cpu_seconds) +
            "," + (r.iterations ? std::to_string(*r.iterations) : "") + "," + std::to_string(r.checks) + "," +
            std::to_string(r.confirm_checks) + "," + text_of(r.valid_segments) + "," + text_of(r.length) + "," +
            text_of(r.length_l1) + "," + text_of(r.arm_length) + "," + text_of(r.hand_length) + "," +
            text_of(r.likeness) + "," + text_of(r.path_seconds) + "," + (r.verified ? (*r.verified ? "1" : "0") : "") +
            "," + text_of(r.clearance) + "," + quoted(r.reason) + "\n";
  }
  return text;
}

std::string json_of(const Report& report) {
  const Queries& queries = report.queries;
  return Json({{"scene", report.scene},
               {"robot", report.robot},
               {"grasps", report.grasps},
               {"human_likeness_reference", report.likeness_reference},
               {"tuning", json(report.tuned_with)},
               {"reported", json(report.reported_with)},
               {"queries",
                {{"seeds", queries.seeds},
                 {"bases_rejected", queries.bases_rejected},
                 {"goals_mean", queries.goals},
                 {"seeds_that_do_not_reach_grasp", queries.unreachable}}},
               {"ranges_tried", list(report.tried)},
               {"rows", list(report.rows)},
               {"comparisons", list(report.comparisons)}})
             .dump(1) +
         "\n";
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw InputError(file.string() + ": cannot write there");
}

}  // namespace opponens::table2
