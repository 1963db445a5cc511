// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/plan_diagnostics.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "cli/records.hpp"
#include "motion/pair_depth.hpp"

namespace opponens::cli {
namespace {

/// In the order of motion::GoalFate.
constexpr std::array<std::string_view, 4> kFates{"rooted", "outside_limits", "in_collision", "not_joined"};

std::string goal_name(const Query& query, int goal) {
  std::string grasps;
  for (const auto* grasp : query.grasps_at(goal)) {
    grasps += (grasps.empty() ? "grasp " : " and ") + short_id(grasp->id) + " of group " + grasp->value.group;
  }
  return "goal " + std::to_string(goal) + " (" + grasps + ")";
}

Json pair_json(const motion::NamePair& pair) { return Json::array({pair.first, pair.second}); }

Json pairs_json(const std::vector<motion::NamePair>& pairs) {
  Json result = Json::array();
  for (const auto& pair : pairs) result.push_back(pair_json(pair));
  return result;
}

Json outside_json(const std::vector<motion::LimitExcess>& outside) {
  Json result = Json::array();
  for (const auto& joint : outside) result.push_back({{"joint", joint.joint}, {"excess_rad", joint.excess}});
  return result;
}

Json goal_json(const motion::GoalDiagnosis& goal, const Query& query) {
  const auto reached = query.grasps_at(goal.goal);
  Json json = {{"goal_index", goal.goal},
               {"grasp", reached.front()->id},
               {"fate", kFates[static_cast<std::size_t>(goal.fate)]},
               {"outside", outside_json(goal.outside)},
               {"pairs", pairs_json(goal.pairs)},
               {"vertices", goal.vertices}};
  for (std::size_t i = 0; reached.size() > 1 && i < reached.size(); ++i) json["grasps"].push_back(reached[i]->id);
  return json;
}

Json start_pairs_json(const motion::PlanDiagnostics& why, const Planning& planning) {
  Json result = Json::array();
  for (const auto& pair : why.start_pairs)
    result.push_back({{"pair", pair_json(pair)}, {"depth_m", planning.start_depth(pair)}});
  return result;
}

std::string depth_words(const motion::NamePair& pair, double depth) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2g mm deep", 1000.0 * depth);
  return pair.first + " with " + pair.second + ": " + (depth > 0.0 ? std::string(text) : "less deep than can be told");
}

}  // namespace

void say_diagnostics(const Console& console, const Run& run, const Planning& planning) {
  if (!run.planned.diagnostics) return;
  const auto name = [&](int goal) { return goal_name(planning.query(), goal); };
  for (const auto& sentence : motion::sentences(*run.planned.diagnostics, name)) console.say("  " + sentence);
  for (const auto& pair : run.planned.diagnostics->start_pairs) {
    console.say("  " + depth_words(pair, planning.start_depth(pair)));
  }
}

void say_failure(const Console& console, const Run& run, const Planning& planning) {
  console.say("seed " + std::to_string(run.seed) + ": " + status_name(run.planned.status) + ": " + run.planned.detail);
  say_diagnostics(console, run, planning);
}

Json diagnostics_json(const Run& run, const Planning& planning) {
  if (!run.planned.diagnostics) return nullptr;
  const auto& why = *run.planned.diagnostics;
  Json pairs = Json::array();
  for (const auto& pair : why.pairs) pairs.push_back({{"pair", pair_json(pair.pair)}, {"count", pair.count}});
  Json goals = Json::array();
  for (const auto& goal : why.goals) goals.push_back(goal_json(goal, planning.query()));
  return {{"start_outside", outside_json(why.start_outside)},
          {"start_pairs", start_pairs_json(why, planning)},
          {"start_vertices", why.start_vertices},
          {"goals", std::move(goals)},
          {"blocked", why.blocked},
          {"explained", why.explained},
          {"pairs", std::move(pairs)},
          {"unconfirmed", why.unconfirmed},
          {"gap_rad", std::isfinite(why.gap) ? Json(why.gap) : Json(nullptr)},
          {"gap_goal_index", why.gap_goal}};
}

}  // namespace opponens::cli
