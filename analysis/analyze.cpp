// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/analyze.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "analysis/movements.hpp"
#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

/// The samples of one movement that belong to a group.
struct Part {
  std::size_t movement = 0;  ///< place among the movements
  bool before = false;       ///< the transition; else from it on
  std::size_t cluster = 0;
  Tally in_sample;
  Tally held_out;
};

struct Group {
  std::string name;
  std::string phase;
  std::vector<Part> parts;
  std::vector<SampleStatistics> clusters;
  CoverageSettings coverage;
  Walls all;
  std::vector<Walls> others;  ///< with each cluster left out; empty with a single one
  SynergyGroup synergies;
  GroupReport report;
};

/// Pre-grasp (or everything) first, then the groups by name.
std::vector<Group> form_groups(const std::vector<Movement>& movements, bool split) {
  Group common;
  common.name = common.phase = split ? "pre-grasp" : "all";
  std::map<std::string, Group> groups;
  for (std::size_t i = 0; i < movements.size(); ++i) {
    common.parts.push_back({i, split, 0, {}, {}});
    Group& group = groups[movements[i].group];
    group.name = movements[i].group;
    group.phase = split ? "grasp" : "all";
    group.parts.push_back({i, false, 0, {}, {}});
  }
  std::vector<Group> result = {std::move(common)};
  for (auto& [name, group] : groups) result.push_back(std::move(group));
  return result;
}

/// A person: subjects of different sources are different people, though both be called "1".
std::string person(const Movement& movement) { return movement.source + '\n' + movement.subject; }

/// One cluster per subject, or per recording when all parts are of one subject.
void form_clusters(Group& group, const std::vector<Movement>& movements) {
  std::set<std::string> subjects;
  for (const Part& part : group.parts) subjects.insert(person(movements[part.movement]));
  const bool by_subject = subjects.size() > 1;
  group.report.cluster = by_subject ? "subject" : "recording";
  std::map<std::string, std::size_t> index;
  std::vector<PairwiseMerge> trees;
  for (Part& part : group.parts) {
    const Movement& movement = movements[part.movement];
    part.cluster = by_subject ? index.try_emplace(person(movement), trees.size()).first->second : trees.size();
    if (part.cluster == trees.size()) trees.emplace_back();
    trees[part.cluster].add(part.before ? movement.before : movement.after);
  }
  for (PairwiseMerge& tree : trees) group.clusters.push_back(std::exchange(tree, {}).result());
  group.report.clusters = static_cast<int>(group.clusters.size());
}

/// Synergies, box and the intervals of the variance; and what the second pass counts with.
std::optional<Failure> learn(Group& group, const Movements& found, const AnalysisSettings& settings, int threads) {
  const auto joints = static_cast<int>(found.joint_names.size());
  GroupReport& report = group.report;
  report.name = group.name;
  report.phase = group.phase;
  report.recordings = static_cast<int>(group.parts.size());
  for (const Part& part : group.parts) {
    const Movement& movement = found.movements[part.movement];
    report.samples += part.before ? movement.begin : movement.samples - movement.begin;
  }
  const std::string title = group.phase == "grasp" ? "group " + group.name : group.phase + " samples of " + group.name;
  if (report.samples <= joints) {
    return Failure{FailureCode::too_few_samples, title + ": " + std::to_string(report.samples) + " samples of " +
                                                     std::to_string(joints) + " joints; more samples than joints are " +
                                                     "needed"};
  }
  form_clusters(group, found.movements);
  const SampleStatistics all = pooled(group.clusters);
  const Eigen::VectorXd resolution = found.resolution * found.scale.cwiseInverse();
  const EffectiveSubspace subspace = effective_subspace(all.covariance, resolution);
  if (subspace.kept.empty()) return Failure{FailureCode::degenerate, title + ": no joint moves"};

  SynergyGroup& synergies = group.synergies;
  synergies.name = group.name;
  synergies.phase = group.phase;
  synergies.basis = principal_axes(all);
  synergies.dof_effective = subspace.dof();
  synergies.dropped_channels = names_at(found.joint_names, subspace.dropped);
  synergies.box =
      make_box(synergies.basis, found.scale, settings.alpha, settings.beta, settings.box_root, synergies.dof_effective);
  report.k = static_cast<int>(synergies.box.axes.cols());
  report.cumulative_variance = cumulative_variance(synergies.basis.variance);
  group.coverage = {settings.alpha, settings.beta,       settings.box_root,
                    resolution,     settings.replicates, settings.confidence};
  group.all = make_walls(all, group.coverage);
  if (group.clusters.size() > 1) {
    Rng rng = stream(settings.seed, "bootstrap/variance/" + group.phase + "/" + group.name);
    report.intervals = cumulative_variance_intervals(group.clusters, settings.replicates, settings.confidence, rng);
    group.others = held_out_walls(group.clusters, group.coverage, threads);
  }
  group.clusters = {};
  return std::nullopt;
}

/// The second pass: what of each part lies inside the box of all and inside that of the other clusters.
void count_coverage(std::vector<Group>& groups, const Movements& found, int order, const RecordingSource& source,
                    const Reading& reading) {
  std::vector<std::size_t> sorted(found.movements.size());  // movements in the order of the source
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = i;
  std::sort(sorted.begin(), sorted.end(),
            [&](std::size_t a, std::size_t b) { return found.movements[a].index < found.movements[b].index; });
  std::vector<std::size_t> indices;
  for (const std::size_t movement : sorted) indices.push_back(found.movements[movement].index);
  std::vector<std::vector<std::pair<Group*, Part*>>> parts(sorted.size());  // by movement
  for (Group& group : groups) {
    for (Part& part : group.parts) parts[part.movement].emplace_back(&group, &part);
  }
  const Eigen::VectorXd inverse = found.scale.cwiseInverse();
  for_each_recording(source, indices, reading, [&](std::size_t place, const Demonstration& recording) {
    const Movement& movement = found.movements[sorted[place]];
    require(recording.id == movement.id && recording.q_h.rows() == movement.samples,
            "analyze: recording " + movement.id + " is another one in the second pass");
    const Eigen::MatrixXd x = analysed_values(recording, order) * inverse.asDiagonal();
    for (const auto& [group, part] : parts[sorted[place]]) {
      const auto rows = part->before ? x.topRows(movement.begin) : x.bottomRows(movement.samples - movement.begin);
      part->in_sample = count_inside(group->all, rows, movement.weight);
      if (!group->others.empty()) {
        part->held_out = count_inside(group->others[part->cluster], rows, movement.weight);
      }
    }
    return true;
  });
}

void report_coverage(Group& group, const AnalysisSettings& settings) {
  std::vector<Tally> in_sample(static_cast<std::size_t>(group.report.clusters));
  std::vector<Tally> held_out(group.others.size());
  for (const Part& part : group.parts) {
    add(in_sample[part.cluster], part.in_sample);
    if (!held_out.empty()) add(held_out[part.cluster], part.held_out);
  }
  Rng rng = stream(settings.seed, "bootstrap/coverage/" + group.phase + "/" + group.name);
  group.report.coverage = coverage_of(group.all, in_sample, held_out, group.coverage, rng);
}

}  // namespace

void validate(const AnalysisSettings& settings) {
  const auto fraction = [](double value, const char* name) {
    require(value > 0.0 && value < 1.0, [&] {
      return "AnalysisSettings: " + std::string(name) + " must be in (0, 1), is " + std::to_string(value);
    });
  };
  fraction(settings.alpha, "alpha");
  fraction(settings.beta, "beta");
  fraction(settings.confidence, "confidence");
  require(std::isfinite(settings.resolution) && settings.resolution >= 0.0,
          "AnalysisSettings: resolution must be >= 0 rad, is " + std::to_string(settings.resolution));
  require(settings.replicates >= 2,
          "AnalysisSettings: replicates must be >= 2, is " + std::to_string(settings.replicates));
  require(!settings.min_window || *settings.min_window >= 2, "AnalysisSettings: min_window must be >= 2 samples");
  require(!settings.group_by.empty(), "AnalysisSettings: group_by must name a label");
  require(settings.order == 0 || settings.order == 1, "AnalysisSettings: order must be 0 or 1");
  if (settings.normalize_by) {
    const JointRanges& ranges = *settings.normalize_by;
    require(ranges.lower.size() == ranges.upper.size() && ranges.lower.allFinite() && ranges.upper.allFinite() &&
                ((ranges.upper - ranges.lower).array() > 0.0).all(),
            "AnalysisSettings: normalize_by must hold finite ranges with lower < upper for every joint");
  }
}

TransitionSettings transition_settings(const AnalysisSettings& settings) {
  return {settings.resolution, settings.min_window, settings.normaliser};
}

Result<Analysis> analyze(const RecordingSource& source, const AnalysisSettings& settings, const Reading& reading) {
  validate(settings);
  if (source.count == 0) return failure(FailureCode::invalid_input, "no recordings to analyze");
  const Reading first{reading.threads, [&](std::size_t done, std::size_t) {
                        if (reading.progress) reading.progress(done, 2 * source.count);
                      }};
  Result<Movements> found = read_movements(source, settings, first);
  if (!found) return tl::make_unexpected(found.error());
  std::vector<Group> groups = form_groups(found->movements, settings.transition.has_value());
  for (Group& group : groups) {
    if (const auto failed = learn(group, *found, settings, reading.threads)) return tl::make_unexpected(*failed);
  }
  for (Movement& movement : found->movements) movement.before = movement.after = {};
  const Reading second{reading.threads, [&](std::size_t done, std::size_t) {
                         if (reading.progress) reading.progress(source.count + done, 2 * source.count);
                       }};
  count_coverage(groups, *found, settings.order, source, second);

  Analysis analysis;
  analysis.synergies.joint_names = found->joint_names;
  analysis.synergies.order = settings.order;
  for (Group& group : groups) {
    report_coverage(group, settings);
    if (analysis.groups.empty()) {
      analysis.synergies.pre_grasp = std::move(group.synergies);
    } else {
      analysis.synergies.grasp.push_back(std::move(group.synergies));
    }
    analysis.groups.push_back(std::move(group.report));
  }
  analysis.transitions = std::move(found->transitions);
  analysis.free_motion = free_motion_reference(std::move(found->free_motions));
  return analysis;
}

Result<Analysis> analyze(const std::vector<Demonstration>& demonstrations, const AnalysisSettings& settings) {
  return analyze(source_of(demonstrations), settings, Reading{});
}

}  // namespace opponens::analysis
