// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/require.hpp"
#include "report/paper_tables.hpp"
#include "report/sections.hpp"

namespace opponens::report {
namespace {

std::string words(PlanStatus status) {
  std::string name = status_name(status);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::optional<double> valid_share(const PlanResult& result) {
  if (result.extends <= 0) return std::nullopt;
  return static_cast<double>(result.extends_grown) / static_cast<double>(result.extends);
}

std::vector<std::string> planners(const PathPart& part) {
  std::vector<std::string> names;
  for (const auto& run : part.runs) {
    if (std::find(names.begin(), names.end(), run.planner) == names.end()) names.push_back(run.planner);
  }
  return names;
}

/// Means over the solved runs of one planner, for Table 2; the success rate over all of them.
void planner_row(Table& table, const PathPart& part, const std::string& planner) {
  using Values = std::vector<std::optional<double>>;
  int runs = 0;
  std::string settings;
  Values iterations, checks, valid, length, likeness;
  for (const auto& run : part.runs) {
    if (run.planner != planner) continue;
    ++runs;
    settings = run.settings;
    if (run.result.status != PlanStatus::solved) continue;
    iterations.emplace_back(static_cast<double>(run.result.iterations));
    checks.emplace_back(static_cast<double>(run.result.collision_checks));
    valid.push_back(valid_share(run.result));
    length.emplace_back(run.result.length_l1);
    if (!run.human_likeness.empty()) likeness.push_back(run.human_likeness.front().value);
  }
  const auto cell = [](const Values& values, int decimals, double factor, const char* unit) {
    const auto mean = mean_of(values);
    return mean ? text(concat({fixed(factor * *mean, decimals), unit})) : text("n/a");
  };
  const double success = static_cast<double>(iterations.size()) / std::max(1, runs);
  const std::string count = concat({std::to_string(runs), runs == 1 ? " run" : " runs"});
  table.row({text(concat({"here, ", planner, " (", count, settings.empty() ? "" : ", ", settings, ")"})),
             text(percent(success, 0)),
             {"<a href=\"#run\">see Run</a>"},
             cell(iterations, 0, 1.0, ""),
             cell(checks, 0, 1.0, ""),
             cell(valid, 1, 100.0, " %"),
             cell(length, 2, 1.0, " rad"),
             cell(likeness, 1, 1.0, " %")});
}

Markup table_two(const PathPart& part) {
  Table table("Planning beside the paper's Table 2 (means over solved runs)",
              {"case", "success rate", "planning time", "# iterations", "# collision checks", "valid segments",
               "path length", "human-likeness"});
  for (const auto& planner : planners(part)) planner_row(table, part, planner);
  for (const auto& row : kPaperTable2) {
    table.row({text(row.name), text(concat({fixed(row.success_percent, 0), " %"})),
               text(concat({fixed(row.planning_seconds, 2), " s"})), text(fixed(row.iterations, 0)),
               text(fixed(row.collision_checks, 0)), text(concat({fixed(row.valid_percent, 1), " %"})),
               text(concat({fixed(row.length_rad, 2), " rad"})), text(concat({fixed(row.likeness_percent, 1), " %"}))});
  }
  Markup out = table.str();
  out += note(
      "The paper's machine, robot model, scene, grasps and reference motions differ from ours, and its formula for "
      "human-likeness is unpublished (ours is named in the documentation): read the columns for what they measure, not "
      "as "
      "a race. Valid segments: here the share of the extensions that grew a tree, in the paper of the iterations. Path "
      "length: sum of weighted joint movements of the path as planned, before the shortcuts. Success rate: solved runs "
      "of all runs of the planner's newest plan command with the same robot, scene, object and grasps.");
  return out;
}

/// The grasps' ids, each with its arm where there are several.
Markup reached_words(const std::vector<ReachedGrasp>& reached) {
  Markup words;
  for (const auto& grasp : reached) {
    words.html += concat({words.html.empty() ? "" : " and ", identifier(grasp.id).html,
                          grasp.arm.empty() ? "" : concat({" (", escape(grasp.arm), ")"})});
  }
  return words;
}

void run_row(Table& table, const PlanRun& run) {
  const auto& result = run.result;
  const bool solved = result.status == PlanStatus::solved;
  std::string likeness;
  for (const auto& item : run.human_likeness) {
    likeness += concat({likeness.empty() ? "" : "; ", item.value ? concat({fixed(*item.value, 1), " %"}) : "none", " (",
                        item.reference, ")"});
  }
  const auto length = [&](std::optional<double> value) { return text(solved && value ? fixed(*value, 2) : "n/a"); };
  table.row({text(run.planner), text(std::to_string(run.seed)), badge(solved, words(result.status)),
             run.reached.empty() ? text("n/a") : reached_words(run.reached), text(grouped(result.iterations)),
             text(grouped(result.collision_checks)), length(result.length), length(result.length_l1),
             length(run.shortened_length), text(likeness)});
}

Markup run_table(const PathPart& part) {
  Table table("Runs", {"planner", "seed", "status", "grasp reached", "iterations", "collision checks",
                       "planned length (rad, joint metric)", "planned length (rad, sum of joints)",
                       "shortened length (rad, joint metric)", "human-likeness, with its reference"});
  for (const auto& run : part.runs) run_row(table, run);
  Markup out = table.str();
  for (const auto& run : part.runs) {
    if (!run.result.detail.empty()) {
      out += note(concat({run.planner, ", seed ", std::to_string(run.seed), ": ", run.result.detail}));
    }
  }
  constexpr std::size_t kFew = 12;
  return part.runs.size() <= kFew ? out : details(concat({"all ", std::to_string(part.runs.size()), " runs"}), out);
}

Markup curves(const ReportInput& input) {
  const auto& part = *input.path;
  const auto& names = part.path.joint_names;
  const Eigen::Index rows = part.path.waypoints.rows();
  const bool timed = part.times.size() > 0;
  const Eigen::VectorXd axis =
      timed ? part.times : Eigen::VectorXd(Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1)));
  std::vector<TimeMark> marks;
  if (part.pregrasp > 0) marks.push_back({"pre-grasp", axis[part.pregrasp]});
  const int arm = input.robot ? input.robot->arm().count : 0;
  const int split = std::clamp(arm, 0, static_cast<int>(names.size()));
  Markup out = subheading("Joint positions along the path");
  const std::string label = timed ? "time (s)" : "waypoint";
  const std::vector<std::string> arm_names(names.begin(), names.begin() + split);
  const std::vector<std::string> hand_names(names.begin() + split, names.end());
  if (split > 0) out += joint_charts(arm_names, axis, label, part.path.waypoints.leftCols(split), marks, 3);
  out += joint_charts(hand_names, axis, label,
                      part.path.waypoints.rightCols(static_cast<Eigen::Index>(hand_names.size())), marks, 4);
  if (timed) {
    out += note(
        "Straight lines join the waypoints, between which speeds change evenly. Velocities and accelerations keep the "
        "limits of every joint; the motion rests at the start, at the pre-grasp and at the grasp, and its corners are "
        "rounded.");
  }
  return out;
}

void check(const PathPart& part) {
  const Eigen::Index rows = part.path.waypoints.rows();
  require(part.path.waypoints.cols() == static_cast<Eigen::Index>(part.path.joint_names.size()) || rows == 0,
          "path: waypoints have another number of columns than joint names");
  require(part.times.size() == 0 || part.times.size() == rows, "path: times differ in number from the waypoints");
  require(part.pregrasp < rows || rows == 0, "path: pregrasp lies beyond the last waypoint");
}

}  // namespace

std::optional<double> mean_of(const std::vector<std::optional<double>>& values) {
  double sum = 0.0;
  int count = 0;
  for (const auto& value : values) {
    if (!value) continue;
    sum += *value;
    ++count;
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

Markup path_section(const ReportInput& input) {
  if (!input.path) return note("No path has been planned yet.");
  const auto& part = *input.path;
  check(part);
  Markup out;
  if (part.path.waypoints.rows() >= 2) {
    const auto& run = part.runs.empty() ? PlanRun{} : part.runs.front();
    Markup words{concat({"<p>Path ", identifier(part.id).html, ", planner ", escape(run.planner), ", seed ",
                         std::to_string(run.seed)})};
    if (!part.reached.empty()) {
      words.html += concat(
          {part.reached.size() == 1 ? ", reaching grasp " : ", reaching grasps ", reached_words(part.reached).html});
    }
    words.html += concat({": ", std::to_string(part.path.waypoints.rows()),
                          " waypoints, shortcuts and closing segment included.</p>\n"});
    out += words;
    out += input.robot && input.scene ? path_snapshots(input)
                                      : note("The robot's model or the scene was not given: no snapshots.");
    out += curves(input);
  } else {
    out += note("The planner found no path.");
  }
  out += subheading("Numbers");
  out += run_table(part);
  out += table_two(part);
  return out;
}

}  // namespace opponens::report
