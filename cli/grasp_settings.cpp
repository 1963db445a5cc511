// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/grasp_settings.hpp"

#include <algorithm>

#include "core/require.hpp"

namespace opponens::cli {

grasp::SearchSettings search_settings(const GraspOptions& options, int threads) {
  grasp::SearchSettings settings;
  settings.count = options.count;
  settings.max_trials = options.trials.value_or(options.max_trials);
  settings.min_trials = options.trials.value_or(options.min_trials);
  settings.improvements = options.improvements;
  settings.mu = options.mu;
  settings.edges = options.edges;
  settings.max_penetration = options.max_penetration;
  settings.clearance_pregrasp = options.clearance;
  settings.slack_bound = options.slack_bound;
  settings.threads = threads;
  return settings;
}

grasp::PrecisionSettings precision_settings(const GraspOptions& options, int threads) {
  const grasp::SearchSettings common = search_settings(options, threads);
  grasp::PrecisionSettings settings;
  settings.count = common.count;
  settings.enough = std::max(settings.enough, 2 * common.count);
  settings.max_trials = options.trials.value_or(std::min(common.max_trials, settings.max_trials));
  if (options.trials) settings.enough = std::max(settings.count, settings.max_trials);  // all of them
  settings.goal = options.goal == "epsilon" ? grasp::PrecisionGoal::epsilon : grasp::PrecisionGoal::min_weight;
  settings.mu = common.mu;
  settings.max_penetration = common.max_penetration;
  settings.clearance_pregrasp = common.clearance_pregrasp;
  settings.distances = common.distances;
  settings.threads = threads;
  return settings;
}

namespace {

/// Of precision grasps, in place of what only the other search has.
Json precision_json(const GraspOptions& options) {
  const auto settings = precision_settings(options, 1);
  return {{"max_trials", settings.max_trials},
          {"min_trials", nullptr},
          {"improvements", nullptr},
          {"enough", settings.enough},
          {"draws", settings.draws},
          {"max_evaluations", settings.max_evaluations},
          {"goal", options.goal}};
}

}  // namespace

Json settings_json(const GraspOptions& options) {
  const grasp::SearchSettings settings = search_settings(options, 1);
  Json result = {{"count", settings.count},
                 {"max_trials", settings.max_trials},
                 {"min_trials", settings.min_trials},
                 {"improvements", settings.improvements},
                 {"mu", settings.mu},
                 {"edges", settings.edges},
                 {"max_penetration", settings.max_penetration},
                 {"clearance", settings.clearance_pregrasp},
                 {"slack_bound", settings.slack_bound},
                 {"free_joints", options.free_joints},
                 {"tips", options.tips},
                 {"noise",
                  {{"position", options.noise.position},
                   {"angle", options.noise.angle},
                   {"friction", options.noise.friction},
                   {"samples", options.noise.samples}}}};
  if (options.tips) result.update(precision_json(options));
  return result;
}

std::vector<SynergyGroup> chosen_groups(const SynergySet& set, const GraspOptions& options) {
  if (set.grasp.empty()) {
    throw InputError("the newest synergies have no groups of the grasp phase; run: opponens analyze --phase both");
  }
  std::string known;
  for (const auto& group : set.grasp) known += (known.empty() ? "" : ", ") + group.name;
  std::vector<SynergyGroup> groups;
  for (const auto& group : set.grasp) {
    if (options.group == "all" || group.name == options.group) groups.push_back(group);
  }
  if (groups.empty()) throw InputError("--group " + options.group + ": no such group; there are: " + known);
  if (options.free_joints) return groups;  // they only name what is found
  const auto still = [](const SynergyGroup& group) { return group.box.half_width.size() == 0; };
  const auto without = std::find_if(groups.begin(), groups.end(), still);
  if (without != groups.end()) {
    throw InputError("group " + without->name +
                     " has no synergies (dimension 0), so there is nothing to search along; choose another --group, "
                     "give it recordings that move, or use --free-joints");
  }
  return groups;
}

}  // namespace opponens::cli
