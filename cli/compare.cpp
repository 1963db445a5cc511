// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdio>
#include <numbers>

#include "analysis/analyze.hpp"
#include "analysis/synergy_distance.hpp"
#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

Stored<SynergySet> synergies(const storage::Store& store, const std::string& id) {
  return id.empty() ? newest_synergies(store) : synergies_of(store, id);
}

/// The ids of the two sets; empty: the newest of its store.
std::array<std::string, 2> chosen(const CompareOptions& options) {
  std::array<std::string, 2> ids;
  for (std::size_t i = 0; i < options.ids.size(); ++i) ids[i] = options.ids[i];
  if (options.with.empty() && options.ids.size() < 2) {
    throw InputError("compare: name two synergy sets of the store, or the other store by --with");
  }
  return ids;
}

Json comparison_json(const analysis::SynergyComparison& one) {
  return {{"name", one.group},
          {"k", {one.k_a, one.k_b}},
          {"angles_rad", array(one.angles)},
          {"distance_rad", number(one.distance)},
          {"variance_shared", {number(one.shared_a), number(one.shared_b)}},
          {"bhattacharyya", number(one.bhattacharyya)},
          {"log_likeness", number(one.log_likeness)}};
}

std::string comparison_line(const analysis::SynergyComparison& one) {
  char text[200];
  std::snprintf(text, sizeof text, "%-14s %3d %3d  %8.3f  %5.1f %%  %5.1f %%", one.group.c_str(), one.k_a, one.k_b,
                one.distance, 100.0 * one.shared_a, 100.0 * one.shared_b);
  std::string line = text;
  std::snprintf(text, sizeof text, "  %13.3f ", one.bhattacharyya.value_or(0.0));
  line += one.bhattacharyya ? text : "              - ";
  for (const double angle : one.angles) {
    std::snprintf(text, sizeof text, " %.0f", 180.0 / std::numbers::pi * angle);
    line += text;
  }
  return line;
}

}  // namespace

int compare(const CompareOptions& options, const Console& console) {
  const auto ids = chosen(options);
  const storage::Store store(options.common.store, false);
  const storage::Store other(options.with.empty() ? options.common.store : options.with, false);
  const Stored<SynergySet> a = synergies(store, ids[0]);
  const Stored<SynergySet> b = synergies(other, ids[1]);
  // Glove sensors' resolution: a joint that never moved is otherwise at an infinite distance from one that did.
  const auto found = analysis::compare(a.value, b.value, analysis::AnalysisSettings{}.resolution);
  if (!found) {
    Console::warn(found.error().detail);
    return found.error().code == FailureCode::invalid_input ? kInvalid : kNoAnswer;
  }
  console.say("group            k   k  distance  variance of each  Bhattacharyya  principal angles");
  console.say("                 a   b       rad  in other's span         distance  degrees");
  Json result = document("compare");
  result["a"] = a.id;
  result["b"] = b.id;
  result["groups"] = Json::array();
  for (const auto& one : *found) {
    console.say(comparison_line(one));
    result["groups"].push_back(comparison_json(one));
  }
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
