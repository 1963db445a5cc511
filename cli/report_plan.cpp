// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/report_plan.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

using report::PathPart;
using report::PlanRun;

/// Of which hands a value is, where several move: ", right hand" or ", mean over hands".
std::string hands_words(const Json& one) {
  if (!one.contains("hands")) return "";
  const Json& hands = one.at("hands");
  return hands.size() == 1 ? ", " + hands[0].get<std::string>() + " hand" : ", mean over hands";
}

std::vector<report::HumanLikeness> likeness_from(const Json& all) {
  std::vector<report::HumanLikeness> result;
  for (const auto& one : all) {
    const std::string reference = one.at("reference");
    const std::string of = one.at("of");
    result.push_back({optional_number(one.at("value")), reference + ", " + of + " path" + hands_words(one)});
  }
  return result;
}

PlanStatus status_from(const std::string& name) {
  const auto found = std::find(kPlanStatusNames.begin(), kPlanStatusNames.end(), name);
  if (found == kPlanStatusNames.end()) throw storage::StorageError("plan_runs: unknown status " + name);
  return static_cast<PlanStatus>(found - kPlanStatusNames.begin());
}

/// "step 0.4 rad, resolution 0.02 rad": what decides whether two rows may be compared.
std::string settings_words(const Json& parameters) {
  std::string words =
      "step " + parameters.at("step").dump() + " rad, resolution " + parameters.at("resolution").dump() + " rad";
  if (parameters.at("max_checks") > 0) words += ", limit " + parameters.at("max_checks").dump() + " checks";
  if (parameters.at("time_limit") > 0.0) words += ", limit " + parameters.at("time_limit").dump() + " s";
  return words;
}

std::vector<report::ReachedGrasp> reached_from(const Json& run) {
  if (!run.at("goal").is_string()) return {};
  if (!run.contains("goals")) return {{"", run.at("goal")}};
  std::vector<report::ReachedGrasp> reached;
  for (const auto& one : run.at("goals")) reached.push_back({one.at("arm"), one.at("grasp")});
  return reached;
}

PlanRun run_from(const Json& json, const Json& parameters) {
  PlanRun run;
  run.planner = parameters.at("planner");
  run.settings = settings_words(parameters);
  run.seed = json.at("seed");
  run.result.status = status_from(json.at("status"));
  run.result.detail = json.at("detail");
  run.result.goal = json.at("goal_index");
  run.reached = reached_from(json);
  run.result.iterations = json.at("iterations");
  run.result.extends = json.at("extends");
  run.result.extends_grown = json.at("extends_grown");
  run.result.collision_checks = json.at("collision_checks");
  run.result.length = optional_number(json.at("length_rad")).value_or(0.0);
  run.result.length_l1 = optional_number(json.at("length_l1_rad")).value_or(0.0);
  run.shortened_length = optional_number(json.at("shortened_length_rad"));
  run.human_likeness = likeness_from(json.at("human_likeness_all"));
  return run;
}

void add_motion(const std::string& id, const storage::Record& record, PathPart& part) {
  part.id = id;
  part.path.joint_names = storage::decode_plan_result(record).path.joint_names;
  part.path.waypoints = std::get<Eigen::MatrixXd>(record.fields.at("motion"));
  part.times = std::get<Eigen::VectorXd>(record.fields.at("times"));
  part.pregrasp = static_cast<int>(std::get<std::int64_t>(record.fields.at("pregrasp_row")));
}

std::vector<PlanRun> runs_of(const storage::Record& record, PathPart& part, bool pictured,
                             const storage::Store& store) {
  const Json parameters = parameters_of(record);
  std::vector<PlanRun> runs;
  std::size_t shown = 0;
  std::string path;
  for (const auto& json : Json::parse(text_field(record, "runs"))) {
    if (json.at("path").is_string()) {
      shown = runs.size();
      path = json.at("path");
    }
    runs.push_back(run_from(json, parameters));
  }
  if (!pictured || path.empty()) return runs;
  add_motion(path, store.read(path), part);
  part.reached = runs[shown].reached;
  std::rotate(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(shown),
              runs.begin() + static_cast<std::ptrdiff_t>(shown) + 1);
  return runs;
}

}  // namespace

std::optional<PathPart> path_part(const storage::Store& store, const std::vector<storage::IndexEntry>& plans) {
  if (plans.empty()) return std::nullopt;
  const std::vector<WorldKey> worlds = world_keys(store.read(plans.front().id));
  PathPart part;
  std::set<std::string> seen;
  for (const auto& entry : plans) {
    const auto record = store.read(entry.id);
    if (entry.inputs != plans.front().inputs || world_keys(record) != worlds) continue;
    if (!seen.insert(parameters_of(record).at("planner")).second) continue;
    const auto runs = runs_of(record, part, entry.id == plans.front().id, store);
    part.runs.insert(part.runs.end(), runs.begin(), runs.end());
  }
  return part;
}

report::RunPart run_part(const storage::Store& store) {
  report::RunPart part;
  std::ifstream file(store.directory() / "runs.jsonl");
  std::ostringstream text;
  text << file.rdbuf();
  part.log = text.str();
  std::istringstream lines(part.log);
  for (std::string line; std::getline(lines, line);) {
    const Json run = Json::parse(line, nullptr, false);
    if (!run.is_object()) continue;
    if (run.contains("command")) {
      part.commands.push_back({run["command"], run.value("date", ""), run.value("wall_seconds", 0.0),
                               run.value("cpu_seconds", 0.0), run.value("threads", 1), run.value("host", "")});
    }
    if (!run.contains("planner_cpu_seconds")) continue;
    const auto seconds = run["planner_cpu_seconds"].get<std::vector<double>>();
    double sum = 0.0;
    for (const double one : seconds) sum += one;
    if (!seconds.empty()) part.planning_seconds[run.value("planner", "")] = sum / static_cast<double>(seconds.size());
  }
  return part;
}

}  // namespace opponens::cli
