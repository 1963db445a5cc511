// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "report/sections.hpp"

namespace opponens::report {
namespace {

std::string recordings_words(const DemonstrationPart& part) {
  int recordings = 0;
  int samples = 0;
  for (const auto& group : part.groups) {
    recordings += group.recordings;
    samples += group.samples;
  }
  std::string origin = "all recorded";
  if (part.simulated >= recordings) origin = "all SIMULATED";
  if (part.simulated > 0 && part.simulated < recordings) {
    origin = concat({std::to_string(part.simulated), " of them SIMULATED"});
  }
  return concat({grouped(recordings), " with ", grouped(samples), " samples, ", origin});
}

std::string group_words(const DemonstrationPart& part) {
  const auto free = std::count_if(part.groups.begin(), part.groups.end(),
                                  [](const RecordingGroup& group) { return group.free_motion; });
  return concat({std::to_string(static_cast<std::int64_t>(part.groups.size()) - free), " by ", part.grouped_by,
                 free > 0 ? ", and free finger motions" : ""});
}

std::string synergy_words(const SynergyPart& part) {
  std::string words;
  for (const auto& item : part.groups) {
    const bool common = item.group.phase == "pre-grasp";
    words += concat({words.empty() ? "" : ", ", common ? "" : part.grouped_by, common ? "" : " ", item.group.name, ": ",
                     std::to_string(item.group.box.half_width.size())});
  }
  return words.empty() ? std::string("none") : words;
}

std::string grasp_words(const GraspPart& part) {
  if (part.items.empty()) return concat({"none of ", part.object, " found"});
  const auto closed = std::count_if(part.items.begin(), part.items.end(),
                                    [](const GraspItem& item) { return item.grasp.quality.force_closure(); });
  const auto along = std::count_if(part.items.begin(), part.items.end(),
                                   [](const GraspItem& item) { return item.grasp.synergy_grasp; });
  std::string words = concat({std::to_string(part.items.size()), " of ", part.object, ", ", std::to_string(closed),
                              " force closure, ", std::to_string(along), " along the synergies and ",
                              std::to_string(static_cast<std::int64_t>(part.items.size()) - along), " free"});
  std::optional<double> best;
  for (const auto& item : part.items) {
    const auto& epsilon = item.grasp.quality.epsilon;
    if (epsilon && (!best || *epsilon > *best)) best = epsilon;
  }
  if (best) words += concat({", best \u03B5 ", significant(*best)});
  return words;
}

std::string grasp_words(const ReportInput& input) {
  if (input.further_hands.empty()) return grasp_words(*input.grasps);
  std::string words = concat({"arm ", input.grasps->arm, ": ", grasp_words(*input.grasps)});
  for (const auto& further : input.further_hands) {
    words += concat({"; arm ", further.grasps.arm, ": ", grasp_words(further.grasps)});
  }
  return words;
}

std::string path_words(const PathPart& part) {
  if (part.runs.empty()) return "not available";
  const auto& run = part.runs.front();
  if (run.result.status != PlanStatus::solved)
    return concat({"none found by ", run.planner, ", seed ", std::to_string(run.seed)});
  std::string words = concat({"as planned ", fixed(run.result.length, 2), " rad in the joint metric, ",
                              fixed(run.result.length_l1, 2), " rad as the sum of weighted joint movements"});
  if (run.shortened_length)
    words += concat({"; shortened ", fixed(*run.shortened_length, 2), " rad in the joint metric"});
  return concat({words, "; by ", run.planner, ", seed ", std::to_string(run.seed)});
}

/// Table 2's; the section of the path has them all.
std::string likeness_words(const PathPart& part) {
  if (part.runs.empty() || part.runs.front().human_likeness.empty()) return "no reference";
  const auto& item = part.runs.front().human_likeness.front();
  return concat({item.value ? concat({fixed(*item.value, 1), " %"}) : "none", ", reference: ", item.reference});
}

Markup verdict(const VerifyPart& part) {
  const auto failed =
      std::count_if(part.verdicts.begin(), part.verdicts.end(), [](const Verdict& v) { return !v.passed; });
  const std::string hashes = concat({"; ", std::to_string(part.checked), " hashes agree"});
  const std::string all = std::to_string(part.verdicts.size());
  if (failed == 0) return badge(true, concat({all, " grasps and paths passed", hashes}));
  return badge(false, concat({std::to_string(failed), " of ", all, " grasps and paths failed", hashes}));
}

}  // namespace

Markup summary_section(const ReportInput& input) {
  const std::string missing = "not available";
  Table table("Key numbers", {"what", "result"});
  table.row({text("recordings"), text(input.demonstrations ? recordings_words(*input.demonstrations) : missing)});
  table.row({text("groups"), text(input.demonstrations ? group_words(*input.demonstrations) : missing)});
  table.row({text("synergies kept (k)"), text(input.synergies ? synergy_words(*input.synergies) : missing)});
  table.row({text("grasps"), text(input.grasps ? grasp_words(input) : missing)});
  table.row({text("path length"), text(input.path ? path_words(*input.path) : missing)});
  table.row({text("human-likeness"), text(input.path ? likeness_words(*input.path) : missing)});
  table.row({text("verification"), input.verification ? verdict(*input.verification) : text(missing)});
  return table.str();
}

}  // namespace opponens::report
