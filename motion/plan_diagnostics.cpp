// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/plan_diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace opponens::motion {
namespace {

constexpr std::size_t kMostNamed = 5;  ///< goals or pairs that one sentence names

std::string radians(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g rad", value);
  return text;
}

/// "a, b and 3 more"
std::string listed(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), kMostNamed); ++i) text += (i == 0 ? "" : ", ") + items[i];
  if (items.size() > kMostNamed) text += " and " + std::to_string(items.size() - kMostNamed) + " more";
  return text;
}

std::string words(const std::vector<LimitExcess>& outside) {
  std::vector<std::string> items;
  for (const LimitExcess& joint : outside) {
    items.push_back(joint.joint +
                    (joint.excess > 0.0 ? " is above its upper limit by " : " is below its lower limit by ") +
                    radians(std::abs(joint.excess)));
  }
  return listed(items);
}

std::string words(const NamePair& pair) { return pair.first + " with " + pair.second; }

std::string words(const std::vector<NamePair>& pairs) {
  std::vector<std::string> items;
  for (const NamePair& pair : pairs) items.push_back(words(pair));
  return listed(items);
}

/// Goals that share a fate and its cause are told together.
void say_goals(const PlanDiagnostics& diagnostics, const std::function<std::string(int)>& name_of,
               std::vector<std::string>& said) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> by_cause;
  for (const GoalDiagnosis& goal : diagnostics.goals) {
    std::string cause;
    if (goal.fate == GoalFate::outside_limits) cause = "outside the joint limits: " + words(goal.outside);
    if (goal.fate == GoalFate::in_collision) {
      cause = "in collision" + (goal.pairs.empty() ? std::string() : ": " + words(goal.pairs));
    }
    // A search that could not start asked about no goal.
    if (goal.fate == GoalFate::not_joined && diagnostics.start_vertices > 0) {
      cause = "to join at a later pass than the search made";
    }
    if (goal.fate == GoalFate::rooted && goal.vertices == 1) cause = "rooted, but its tree never grew";
    if (cause.empty()) continue;
    auto& names = by_cause[cause];
    if (names.empty()) order.push_back(cause);
    names.push_back(name_of(goal.goal));
  }
  for (const std::string& cause : order) said.push_back(listed(by_cause[cause]) + ": " + cause);
}

}  // namespace

std::vector<std::string> sentences(const PlanDiagnostics& diagnostics,
                                   const std::function<std::string(int goal)>& name_of) {
  std::vector<std::string> said;
  if (!diagnostics.start_outside.empty()) said.push_back("at the start " + words(diagnostics.start_outside));
  if (!diagnostics.start_pairs.empty()) said.push_back("at the start collide: " + words(diagnostics.start_pairs));
  say_goals(diagnostics, name_of, said);
  if (diagnostics.start_vertices == 1) said.emplace_back("the start's tree never grew");
  if (!diagnostics.pairs.empty()) {
    std::vector<std::string> items;
    for (const PairCount& pair : diagnostics.pairs)
      items.push_back(words(pair.pair) + " in " + std::to_string(pair.count));
    said.push_back("of " + std::to_string(diagnostics.blocked) + " blocked steps " +
                   std::to_string(diagnostics.explained) + " were looked at; collided most: " + listed(items));
  }
  if (std::isfinite(diagnostics.gap)) {
    said.push_back("the trees came within " + radians(diagnostics.gap) + " of each other, towards " +
                   name_of(diagnostics.gap_goal));
  }
  if (diagnostics.unconfirmed > 0) {
    said.push_back(std::to_string(diagnostics.unconfirmed) + " paths were found that a stricter check did not confirm");
  }
  return said;
}

}  // namespace opponens::motion
