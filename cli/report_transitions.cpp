// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/report_transitions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "analysis/analyze.hpp"

namespace opponens::cli {
namespace {

using namespace opponens::report;

/// Two sources may use the same name.
using SourceAndId = std::pair<std::string, std::string>;

/// sourced: false for a document of an analysis that did not yet name the sources.
SourceAndId key_of(const Demonstration& motion, bool sourced = true) {
  const auto source = motion.labels.find("source");
  return {sourced && source != motion.labels.end() ? source->second : std::string(), motion.id};
}

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

/// The recordings at the quantiles 50, 10 and 90 % of how far the two rules lie apart. split: the motions of part.all.
void add_typical_curves(const std::vector<const Demonstration*>& split, TransitionPart& part) {
  struct Apart {
    double distance;
    SourceAndId key;
    const Demonstration* motion;
  };
  std::vector<Apart> apart;
  for (std::size_t i = 0; i < split.size(); ++i) {
    const auto& one = part.all[i];
    if (one.likeness && one.changepoint)
      apart.push_back({std::abs(*one.likeness - *one.changepoint), key_of(*split[i]), split[i]});
  }
  if (apart.empty()) return;
  std::sort(apart.begin(), apart.end(), [](const Apart& a, const Apart& b) {
    return std::tie(a.distance, a.key.second, a.key.first) < std::tie(b.distance, b.key.second, b.key.first);
  });
  std::set<SourceAndId> drawn;
  for (const double share : {0.5, 0.1, 0.9}) {
    const Apart& one = apart[static_cast<std::size_t>(std::lround(share * static_cast<double>(apart.size() - 1)))];
    if (!drawn.insert(one.key).second) continue;
    auto curves = example_curves(*one.motion);
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
  std::map<SourceAndId, TransitionFractions> fractions;
  bool sourced = false;
  for (const auto& one : found.at("transitions")) {
    sourced = sourced || one.contains("source");
    auto& entry = fractions[{one.value("source", ""), one.at("demonstration")}];
    (one.at("method") == "likeness" ? entry.likeness : entry.changepoint) = one.at("fraction").get<double>();
  }
  std::vector<const Demonstration*> split;
  for (const auto& motion : motions) {
    const auto entry = fractions.find(key_of(motion.value, sourced));
    if (entry == fractions.end()) continue;
    split.push_back(&motion.value);
    entry->second.demonstration = motion.value.id;
    entry->second.known = known_fraction(motion.value);
    part.all.push_back(entry->second);
  }
  add_typical_curves(split, part);
  return part;
}

}  // namespace opponens::cli
