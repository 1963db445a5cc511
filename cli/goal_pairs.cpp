// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/goal_pairs.hpp"

#include <algorithm>
#include <utility>

#include "core/require.hpp"

namespace opponens::cli {
namespace {

using Bodies = std::map<robot::BodyPair, std::size_t>;

Bodies::const_iterator most_frequent(const Bodies& bodies) {
  return std::max_element(bodies.begin(), bodies.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
}

/// Pairs (i, j) of indices below `first` and `second`, in ascending sum.
std::vector<std::pair<std::size_t, std::size_t>> in_order(std::size_t first, std::size_t second) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < first; ++i) {
    for (std::size_t j = 0; j < second; ++j) pairs.emplace_back(i, j);
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.first + a.second < b.first + b.second; });
  return pairs;
}

void count(GoalFault fault, PairTally& tally) {
  PairTally::Reason& reason = tally.left_out[fault.reason];
  ++reason.pairs;
  // Several shapes of two bodies, and both orders of their names, count once.
  for (auto& [first, second] : fault.bodies) {
    if (second < first) std::swap(first, second);
  }
  std::sort(fault.bodies.begin(), fault.bodies.end());
  fault.bodies.erase(std::unique(fault.bodies.begin(), fault.bodies.end()), fault.bodies.end());
  for (const robot::BodyPair& pair : fault.bodies) ++reason.bodies[pair];
}

}  // namespace

PairTally add_pairs(Query& query, const robot::RobotModel& robot, std::size_t most, const FaultOf& fault_of) {
  require(query.arm_goals.size() == 2, "plan: goals are paired where two arms are driven");
  const auto pairs = in_order(query.arm_goals[0].size(), query.arm_goals[1].size());
  PairTally tally;
  tally.possible = pairs.size();
  for (const auto& [i, j] : pairs) {
    if (tally.kept == most) break;
    if (interrupt_requested) throw Interrupted();
    ++tally.asked;
    Goal goal = goal_of(query, robot, {query.arm_goals[0][i], query.arm_goals[1][j]});
    if (auto fault = fault_of(goal)) {
      count(std::move(*fault), tally);
      continue;
    }
    query.add(std::move(goal));
    ++tally.kept;
  }
  return tally;
}

std::string left_out_words(const PairTally& tally) {
  if (tally.left_out.empty()) return "";
  std::string reasons;
  for (const auto& [name, reason] : tally.left_out) {
    reasons += (reasons.empty() ? ": " : ", ") + std::to_string(reason.pairs) + " " + name;
    if (reason.bodies.empty()) continue;
    const robot::BodyPair& pair = most_frequent(reason.bodies)->first;
    reasons += " (most often " + pair.first + " with " + pair.second + ")";
  }
  return std::to_string(tally.asked - tally.kept) + " of " + std::to_string(tally.asked) + " pairs of grasps left out" +
         reasons;
}

Json pairs_json(const PairTally& tally) {
  Json left_out = Json::array();
  for (const auto& [name, reason] : tally.left_out) {
    Json bodies = Json::array();
    for (const auto& [pair, pairs] : reason.bodies) {
      bodies.push_back({{"pair", Json::array({pair.first, pair.second})}, {"count", pairs}});
    }
    left_out.push_back({{"reason", name}, {"count", reason.pairs}, {"bodies", std::move(bodies)}});
  }
  return {
      {"possible", tally.possible}, {"asked", tally.asked}, {"kept", tally.kept}, {"left_out", std::move(left_out)}};
}

}  // namespace opponens::cli
