// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/path.hpp"

namespace opponens::motion {

/// Names of two bodies that collide.
using NamePair = std::pair<std::string, std::string>;

struct LimitExcess {
  std::string joint;
  double excess = 0.0;  ///< rad, > 0: above the upper limit, < 0: below the lower one
};

enum class GoalFate {
  rooted,          ///< grew a tree, or could have
  outside_limits,  ///< see GoalDiagnosis::outside
  in_collision,    ///< see GoalDiagnosis::pairs
  not_joined,      ///< the search ended before it was asked about: it was to join later, or the start was refused
};

struct GoalDiagnosis {
  int goal = -1;  ///< Root::goal
  GoalFate fate = GoalFate::not_joined;
  std::vector<LimitExcess> outside;
  std::vector<NamePair> pairs;  ///< when World::explain is given; of the first 32 goals in collision
  std::int64_t vertices = 0;    ///< of its tree, the root included: 1 when it never grew
};

struct PairCount {
  NamePair pair;
  std::int64_t count = 0;  ///< explained configurations in which the pair collided
};

/// Why a search ended as it did.
struct PlanDiagnostics {
  std::vector<LimitExcess> start_outside;
  std::vector<NamePair> start_pairs;
  std::int64_t start_vertices = 0;   ///< of the start's tree, its root included
  std::vector<GoalDiagnosis> goals;  ///< in the order of the query
  std::int64_t blocked = 0;          ///< extensions that an invalid configuration ended
  std::int64_t explained = 0;        ///< of those configurations, spread evenly over the search: asked for their pairs
  std::vector<PairCount> pairs;      ///< most frequent first, then by name
  std::int64_t unconfirmed = 0;      ///< paths found of which a motion failed World::confirm
  double gap = std::numeric_limits<double>::infinity();  ///< rad, the nearest that the graphs came without meeting
  int gap_goal = -1;                                     ///< goal of the tree that came so near
};

/// A planner's answer with what is not stored of it.
struct PlanAnswer : PlanResult {
  std::int64_t goals_refused = 0;  ///< outside the limits or in collision when they were to be rooted
  /// Given when the search failed, or PlannerSettings::diagnose asks for it.
  std::optional<PlanDiagnostics> diagnostics;
};

/// The same for a person, a sentence each, most important first. name_of: what a goal is called.
std::vector<std::string> sentences(const PlanDiagnostics& diagnostics,
                                   const std::function<std::string(int goal)>& name_of);

}  // namespace opponens::motion
