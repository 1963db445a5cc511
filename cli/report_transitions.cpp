// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/report_transitions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "analysis/analyze.hpp"

namespace opponens::cli {
namespace {

using namespace opponens::report;

/// Known transition of a motion as a fraction of its duration.
std::optional<double> known_fraction(const Demonstration& motion) {
  if (!motion.known_transition) return std::nullopt;
  const double begin = motion.time(0);
  return (*motion.known_transition - begin) / (motion.time(motion.time.size() - 1) - begin);
}

std::optional<TransitionCurves> example_curves(const Demonstration& motion) {
  const auto curves = analysis::transition_curves(motion, {});
  if (!curves) return std::nullopt;
  using analysis::TransitionRule;
  TransitionCurves example;
  example.demonstration = motion.id;
  example.time = motion.time.segment(curves->first, curves->log_likeness.size());
  example.log_likeness = curves->log_likeness;
  example.changepoint_cost = curves->changepoint;
  example.likeness_time = analysis::transition(motion, *curves, TransitionRule::likeness).time_s;
  example.changepoint_time = analysis::transition(motion, *curves, TransitionRule::changepoint).time_s;
  example.known_time = motion.known_transition;
  return example;
}

/// The recordings at the quantiles 50, 10 and 90 % of how far the two rules lie apart.
void add_typical_curves(const std::vector<Stored<Demonstration>>& motions, TransitionPart& part) {
  std::vector<std::pair<double, std::string>> apart;
  for (const auto& one : part.all) {
    if (one.likeness && one.changepoint)
      apart.emplace_back(std::abs(*one.likeness - *one.changepoint), one.demonstration);
  }
  if (apart.empty()) return;
  std::sort(apart.begin(), apart.end());
  std::set<std::string> drawn;
  for (const double share : {0.5, 0.1, 0.9}) {
    const auto& id = apart[static_cast<std::size_t>(std::lround(share * static_cast<double>(apart.size() - 1)))].second;
    if (!drawn.insert(id).second) continue;
    const auto motion =
        std::find_if(motions.begin(), motions.end(), [&](const auto& one) { return one.value.id == id; });
    auto curves = example_curves(motion->value);
    if (!curves) continue;
    if (part.example) {
      part.others.push_back(std::move(*curves));
    } else {
      part.example = std::move(curves);
    }
  }
  part.chosen_by =
      "Drawn are the recordings at the median, the 10 % and the 90 % quantile of how far the two rules lie apart.";
}

}  // namespace

TransitionPart transition_part(const std::vector<Stored<Demonstration>>& motions, const Json& found,
                               const std::string& method) {
  TransitionPart part;
  part.method = method;
  std::map<std::string, TransitionFractions> by_id;
  for (const auto& one : found.at("transitions")) {
    auto& entry = by_id[one.at("demonstration")];
    (one.at("method") == "likeness" ? entry.likeness : entry.changepoint) = one.at("fraction").get<double>();
  }
  for (const auto& motion : motions) {
    const auto entry = by_id.find(motion.value.id);
    if (entry == by_id.end()) continue;
    entry->second.demonstration = motion.value.id;
    entry->second.known = known_fraction(motion.value);
    part.all.push_back(entry->second);
  }
  add_typical_curves(motions, part);
  return part;
}

}  // namespace opponens::cli
