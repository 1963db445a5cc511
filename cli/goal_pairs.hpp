// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "cli/query.hpp"

namespace opponens::cli {

/// Why a goal is of no use.
struct GoalFault {
  std::string reason;                   ///< "in collision at the pre-grasp", ...
  std::vector<robot::BodyPair> bodies;  ///< what is in each other's way; empty: nothing of that kind
  bool closing = false;                 ///< of the closing segment alone
};
/// nullopt: the goal will do.
using FaultOf = std::function<std::optional<GoalFault>(const Goal&)>;

/// What became of the pairs of two arms' goals.
struct PairTally {
  struct Reason {
    std::size_t pairs = 0;
    std::map<robot::BodyPair, std::size_t> bodies;  ///< pairs of goals in which these were in the way
  };
  std::size_t possible = 0;
  std::size_t asked = 0;  ///< all, unless enough were found before
  std::size_t kept = 0;
  std::map<std::string, Reason> left_out;
};

/// Adds to the query the goals of two arms together: the pairs without a fault, in ascending sum of their ranks, `most`
/// of them. Throws Interrupted.
PairTally add_pairs(Query& query, const robot::RobotModel& robot, std::size_t most, const FaultOf& fault_of);

/// "37 of 40 pairs of grasps left out: 31 in collision at the pre-grasp (most often A with B), ..."; empty: none.
std::string left_out_words(const PairTally& tally);
Json pairs_json(const PairTally& tally);

}  // namespace opponens::cli
