// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/analyze.hpp"

#include <algorithm>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "robot/load_robot.hpp"
#include "robot/robot_model.hpp"
#include "storage/codec.hpp"
#include "storage/readers/source.hpp"

namespace opponens::cli {
namespace {

using analysis::Analysis;
using analysis::AnalysisSettings;

analysis::BoxRoot box_root(const std::string& name) {
  if (name == "k") return analysis::BoxRoot::k;
  return name == "literal" ? analysis::BoxRoot::literal : analysis::BoxRoot::n;
}

const char* rule_name(analysis::TransitionRule rule) {
  return rule == analysis::TransitionRule::likeness ? "likeness" : "changepoint";
}

/// What is analysed: hand motions when there are any, else the glove recordings.
std::vector<storage::IndexEntry> input_motions(const storage::Store& store, const std::string& input,
                                               const Console& console) {
  MotionEntries motions;
  if (input != "glove") motions = newest_motions(store, kHandMotion);
  if (motions.newest.empty() && input != "hand") {
    motions = newest_motions(store, kRecording);
    say_superseded(console, motions.superseded);
  }
  if (motions.newest.empty()) {
    throw InputError(store.directory().string() + ": nothing to analyse" +
                     (input == "hand" ? "; run: opponens retarget" : "; run: opponens simulate, or opponens ingest"));
  }
  return motions.newest;
}

/// Joint ranges for --space normalized: those of the hand that the motions were mapped to.
analysis::JointRanges joint_ranges(const storage::Record& record) {
  if (record.kind != kHandMotion)
    throw InputError("--space normalized needs motions of a robot hand; run: opponens retarget");
  const robot::RobotModel hand(hand_of_motion(record));
  const std::vector<std::string> names = storage::decode_demonstration(record).joint_names;
  const auto size = static_cast<Eigen::Index>(names.size());
  analysis::JointRanges ranges{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  for (Eigen::Index i = 0; i < size; ++i) {  // by name: a recording of a robot hand has an order of its own
    const std::string& name = names[static_cast<std::size_t>(i)];
    const auto found = std::find(hand.joint_names().begin(), hand.joint_names().end(), name);
    if (found == hand.joint_names().end()) throw InputError("--space normalized: the hand has no joint " + name);
    const auto joint = found - hand.joint_names().begin();
    ranges.lower[i] = hand.lower()[joint];
    ranges.upper[i] = hand.upper()[joint];
  }
  return ranges;
}

/// first: one of the motions.
AnalysisSettings settings_from(const AnalyzeOptions& options, const storage::Store& store, const std::string& first) {
  AnalysisSettings settings;
  settings.alpha = options.alpha;
  settings.beta = options.beta;
  settings.box_root = box_root(options.box_root);
  settings.group_by = options.group_by;
  settings.order = options.order;
  settings.seed = options.common.seed;
  settings.resolution = options.resolution;
  if (options.min_window > 0) settings.min_window = options.min_window;
  if (options.phase == "none") {
    if (!options.transition.empty())
      throw InputError("--phase none makes no split: --transition has nothing to decide");
    settings.transition.reset();
  } else if (options.transition == "changepoint") {
    settings.transition = analysis::TransitionRule::changepoint;
  }
  if (options.space == "normalized") settings.normalize_by = joint_ranges(store.read(first));
  return settings;
}

Json interval_json(const std::optional<analysis::Interval>& interval) {
  return interval ? Json{number(interval->low), number(interval->high)} : Json(nullptr);
}

Json coverage_json(const analysis::Coverage& coverage) {
  return {{"in_sample", number(coverage.in_sample)},
          {"held_out", number(coverage.held_out)},
          {"interval", interval_json(coverage.interval)},
          {"nominal", number(coverage.nominal)}};
}

Json group_json(const SynergyGroup& group, const analysis::GroupReport& found) {
  Json intervals = Json::array();
  for (const auto& interval : found.intervals) intervals.push_back({interval.low, interval.high});
  return {{"name", group.name},
          {"phase", group.phase},
          {"samples", found.samples},
          {"recordings", found.recordings},
          {"clusters", found.clusters},
          {"cluster", found.cluster},
          {"dof_effective", group.dof_effective},
          {"dropped_channels", group.dropped_channels},
          {"cumulative_variance", array(found.cumulative_variance)},
          {"cumulative_variance_interval", intervals},
          {"k", found.k},
          {"half_width", array(group.box.half_width)},
          {"coverage", coverage_json(found.coverage.full)},
          {"coverage_k", coverage_json(found.coverage.kept)}};
}

Json transition_json(const analysis::TransitionReport& found, analysis::TransitionRule rule) {
  const bool likeness = rule == analysis::TransitionRule::likeness;
  const auto& one = likeness ? found.likeness : found.changepoint;
  return {{"demonstration", found.demonstration},
          {"source", found.source},
          {"index", one.index},
          {"time_s", number(one.time_s)},
          {"fraction", number(one.fraction)},
          {"method", rule_name(rule)},
          {"error_fraction", number(likeness ? found.likeness_error : found.changepoint_error)}};
}

/// The result document; the transitions of the rule in force come first.
Json analysis_json(const Analysis& found, const AnalysisSettings& settings) {
  Json result = document("analyze");
  result["groups"] = Json::array();
  const auto groups = groups_in_order(found.synergies);
  for (std::size_t i = 0; i < groups.size(); ++i) result["groups"].push_back(group_json(*groups[i], found.groups[i]));
  result["joint_names"] = found.synergies.joint_names;
  result["order"] = found.synergies.order;
  result["transitions"] = Json::array();
  using analysis::TransitionRule;
  const auto first = settings.transition.value_or(TransitionRule::likeness);
  const auto second = first == TransitionRule::likeness ? TransitionRule::changepoint : TransitionRule::likeness;
  for (const auto rule : {first, second}) {
    for (const auto& one : found.transitions) result["transitions"].push_back(transition_json(one, rule));
  }
  return result;
}

void say_groups(const Console& console, const Analysis& found) {
  console.say("group        recordings  samples  dof   k   variance of the first 1, 3, 5 synergies");
  const auto groups = groups_in_order(found.synergies);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto& variance = found.groups[i].cumulative_variance;
    const auto percent = [&](int k) { return 100.0 * variance(std::min<Eigen::Index>(k, variance.size()) - 1); };
    char line[200];
    std::snprintf(line, sizeof line, "%-12s %10d %8d %4d %3d   %5.1f %%  %5.1f %%  %5.1f %%", groups[i]->name.c_str(),
                  found.groups[i].recordings, found.groups[i].samples, groups[i]->dof_effective, found.groups[i].k,
                  percent(1), percent(3), percent(5));
    console.say(line);
  }
}

Json parameters_json(const AnalyzeOptions& options) {
  return {{"alpha", options.alpha},
          {"beta", options.beta},
          {"transition", options.transition.empty() ? "likeness" : options.transition},
          {"box_root", options.box_root},
          {"group_by", options.group_by},
          {"order", options.order},
          {"resolution", options.resolution},
          {"min_window", options.min_window},
          {"space", options.space},
          {"phase", options.phase},
          {"input", options.input}};
}

}  // namespace

int analyze(const AnalyzeOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const int threads = thread_count(options.common.threads);
  const RunLog log(store, "analyze", threads);
  const auto motions = input_motions(store, options.input, console);
  const AnalysisSettings settings = settings_from(options, store, motions.front().id);
  std::vector<std::string> inputs;
  for (const auto& motion : motions) inputs.push_back(motion.id);
  const analysis::RecordingSource source{
      inputs.size(), [&](std::size_t i) { return storage::decode_demonstration(store.read(inputs[i])); }};
  Progress progress(console, "analyze: recordings, each read twice");
  const auto found = analysis::analyze(source, settings, {threads, progress.counter()});
  if (!found) {
    Console::warn(found.error().detail);
    return found.error().code == FailureCode::invalid_input ? kInvalid : kNoAnswer;
  }
  const std::string result = analysis_json(*found, settings).dump();
  auto record = storage::encode(found->synergies,
                                provenance("analyze", inputs, {}, parameters_json(options), options.common.seed));
  record.fields["analysis"] = result;
  log.finish(store.commit({record}));
  say_groups(console, *found);
  console.document(result);
  return kDone;
}

}  // namespace opponens::cli
