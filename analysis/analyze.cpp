// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/analyze.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

/// The samples of one movement that belong to a group.
struct Part {
  const Demonstration* demonstration;
  int first;  ///< row
  int count;
};

struct Group {
  std::string name;
  std::string phase;
  std::vector<Part> parts;
};

std::string label(const Demonstration& demonstration, const std::string& name) {
  const auto found = demonstration.labels.find(name);
  return found == demonstration.labels.end() ? std::string() : found->second;
}

std::optional<Failure> fault(const Demonstration& demonstration, const std::vector<std::string>& joint_names) {
  const auto invalid = [&](const std::string& what) {
    return Failure{FailureCode::invalid_input, "recording " + demonstration.id + ": " + what};
  };
  const Eigen::Index samples = demonstration.q_h.rows();
  if (demonstration.joint_names != joint_names) return invalid("its joints differ from those of the first recording");
  if (samples < 2 || demonstration.time.size() != samples ||
      demonstration.q_h.cols() != static_cast<Eigen::Index>(joint_names.size())) {
    return invalid("needs at least 2 samples, and time and joints of matching size");
  }
  if (!demonstration.q_h.allFinite() || !demonstration.time.allFinite()) return invalid("a value is not finite");
  if (!((demonstration.time.tail(samples - 1) - demonstration.time.head(samples - 1)).array() > 0.0).all()) {
    return invalid("time does not increase");
  }
  if (!(demonstration.weight > 0.0) || !std::isfinite(demonstration.weight)) return invalid("its weight is not > 0");
  return std::nullopt;
}

using Movements = std::vector<const Demonstration*>;  // by id

/// Recordings given twice would be taken for independent ones. Two sources may use the same name.
std::optional<Failure> repetition(const std::vector<Demonstration>& demonstrations) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const Demonstration& demonstration : demonstrations) {
    const std::string source = label(demonstration, "source");
    if (seen.insert({source, demonstration.id}).second) continue;
    return Failure{FailureCode::invalid_input, "recording " + demonstration.id + " is given twice" +
                                                   (source.empty() ? "" : " (source " + source + ")")};
  }
  return std::nullopt;
}

Result<Movements> sort_and_check(const std::vector<Demonstration>& demonstrations, const AnalysisSettings& settings) {
  if (const auto found = repetition(demonstrations)) return tl::make_unexpected(*found);
  Movements movements;
  for (const Demonstration& demonstration : demonstrations) {
    if (const auto found = fault(demonstration, demonstrations.front().joint_names)) {
      return tl::make_unexpected(*found);
    }
    if (is_free_motion(demonstration)) continue;
    if (label(demonstration, settings.group_by).empty()) {
      return failure(FailureCode::invalid_input,
                     "recording " + demonstration.id + " has no label '" + settings.group_by + "' to group by");
    }
    movements.push_back(&demonstration);
  }
  if (movements.empty()) return failure(FailureCode::invalid_input, "no movements to analyze");
  std::stable_sort(movements.begin(), movements.end(), [](const Demonstration* a, const Demonstration* b) {
    return std::pair(a->id, label(*a, "source")) < std::pair(b->id, label(*b, "source"));
  });
  return movements;
}

Result<TransitionReport> find_transition(const Demonstration& demonstration, const AnalysisSettings& settings) {
  const Result<TransitionCurves> curves = transition_curves(demonstration, transition_settings(settings));
  if (!curves) return tl::make_unexpected(curves.error());
  TransitionReport report;
  report.demonstration = demonstration.id;
  report.likeness = transition(demonstration, *curves, TransitionRule::likeness);
  report.changepoint = transition(demonstration, *curves, TransitionRule::changepoint);
  report.dropped_channels = curves->dropped_channels;
  if (demonstration.known_transition) {
    const double duration = demonstration.time[demonstration.time.size() - 1] - demonstration.time[0];
    report.likeness_error = (report.likeness.time_s - *demonstration.known_transition) / duration;
    report.changepoint_error = (report.changepoint.time_s - *demonstration.known_transition) / duration;
  }
  return report;
}

/// Pre-grasp (or everything) first, then the groups by name. splits: first grasp sample by movement, empty: no split.
std::vector<Group> form_groups(const std::vector<const Demonstration*>& movements,
                               const std::map<const Demonstration*, int>& splits, const AnalysisSettings& settings) {
  const bool split = settings.transition.has_value();
  Group common{split ? "pre-grasp" : "all", split ? "pre-grasp" : "all", {}};
  std::map<std::string, Group> groups;
  for (const Demonstration* movement : movements) {
    const auto samples = static_cast<int>(movement->q_h.rows());
    const int begin = split ? splits.at(movement) : 0;
    common.parts.push_back({movement, 0, split ? begin : samples});
    const std::string name = label(*movement, settings.group_by);
    Group& group = groups.try_emplace(name, Group{name, split ? "grasp" : "all", {}}).first->second;
    group.parts.push_back({movement, begin, samples - begin});
  }
  std::vector<Group> result{common};
  for (auto& [name, group] : groups) result.push_back(std::move(group));
  return result;
}

/// One cluster per subject, or per recording when all parts are of one subject.
std::vector<Cluster> form_clusters(const Group& group, const Eigen::VectorXd& scale, std::string& kind) {
  std::set<std::string> subjects;
  for (const Part& part : group.parts) subjects.insert(label(*part.demonstration, "subject"));
  kind = subjects.size() > 1 ? "subject" : "recording";
  std::map<std::string, std::size_t> index;
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < group.parts.size(); ++i) {
    const Part& part = group.parts[i];
    const Demonstration& demonstration = *part.demonstration;
    std::size_t at = clusters.size();
    if (kind == "subject") at = index.try_emplace(label(demonstration, "subject"), at).first->second;
    if (at == clusters.size()) clusters.emplace_back();
    Cluster& cluster = clusters[at];
    const Eigen::MatrixXd x = demonstration.q_h.middleRows(part.first, part.count) * scale.cwiseInverse().asDiagonal();
    cluster.statistics = merge(cluster.statistics, moments(x, demonstration.weight));
    cluster.samples.push_back(x);
    cluster.weights.push_back(demonstration.weight);
  }
  return clusters;
}

struct Learnt {
  SynergyGroup synergies;
  GroupReport report;
};

Result<Learnt> learn(const Group& group, const std::vector<std::string>& joint_names, const Eigen::VectorXd& scale,
                     const AnalysisSettings& settings) {
  const auto joints = static_cast<int>(joint_names.size());
  Learnt learnt;
  GroupReport& report = learnt.report;
  report.name = group.name;
  report.phase = group.phase;
  report.recordings = static_cast<int>(group.parts.size());
  for (const Part& part : group.parts) report.samples += part.count;
  const std::string title = group.phase == "grasp" ? "group " + group.name : group.phase + " samples of " + group.name;
  if (report.samples <= joints) {
    return failure(FailureCode::too_few_samples, title + ": " + std::to_string(report.samples) + " samples of " +
                                                     std::to_string(joints) + " joints; more samples than joints are " +
                                                     "needed");
  }
  const std::vector<Cluster> clusters = form_clusters(group, scale, report.cluster);
  report.clusters = static_cast<int>(clusters.size());
  std::vector<SampleStatistics> statistics;
  for (const Cluster& cluster : clusters) statistics.push_back(cluster.statistics);
  const SampleStatistics all = pooled(statistics);
  const Eigen::VectorXd resolution = settings.resolution * scale.cwiseInverse();
  const EffectiveSubspace subspace = effective_subspace(all.covariance, resolution);
  if (subspace.kept.empty()) return failure(FailureCode::degenerate, title + ": no joint moves");

  SynergyGroup& synergies = learnt.synergies;
  synergies.name = group.name;
  synergies.phase = group.phase;
  synergies.basis = principal_axes(all);
  synergies.dof_effective = subspace.dof();
  synergies.dropped_channels = names_at(joint_names, subspace.dropped);
  synergies.box =
      make_box(synergies.basis, scale, settings.alpha, settings.beta, settings.box_root, synergies.dof_effective);
  report.k = static_cast<int>(synergies.box.axes.cols());
  report.cumulative_variance = cumulative_variance(synergies.basis.variance);

  const std::string purpose = group.phase + "/" + group.name;
  if (clusters.size() > 1) {
    Rng variance_rng = stream(settings.seed, "bootstrap/variance/" + purpose);
    report.intervals =
        cumulative_variance_intervals(statistics, settings.replicates, settings.confidence, variance_rng);
  }
  Rng coverage_rng = stream(settings.seed, "bootstrap/coverage/" + purpose);
  report.coverage = box_coverage(
      clusters,
      {settings.alpha, settings.beta, settings.box_root, resolution, settings.replicates, settings.confidence},
      coverage_rng);
  return learnt;
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

Result<Analysis> analyze(const std::vector<Demonstration>& demonstrations, const AnalysisSettings& settings) {
  validate(settings);
  if (demonstrations.empty()) return failure(FailureCode::invalid_input, "no recordings to analyze");
  const Result<Movements> movements = sort_and_check(demonstrations, settings);
  if (!movements) return tl::make_unexpected(movements.error());
  Analysis analysis;
  analysis.synergies.joint_names = demonstrations.front().joint_names;
  const auto joints = static_cast<Eigen::Index>(analysis.synergies.joint_names.size());
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(joints);
  if (settings.normalize_by) {
    require(settings.normalize_by->lower.size() == joints, "analyze: normalize_by needs one range per joint");
    scale = settings.normalize_by->upper - settings.normalize_by->lower;
  }

  std::map<const Demonstration*, int> splits;
  if (settings.transition) {
    for (const Demonstration& demonstration : demonstrations) {
      if (is_free_motion(demonstration)) continue;
      const Result<TransitionReport> found = find_transition(demonstration, settings);
      if (!found) return tl::make_unexpected(found.error());
      splits[&demonstration] =
          *settings.transition == TransitionRule::likeness ? found->likeness.index : found->changepoint.index;
      analysis.transitions.push_back(*found);
    }
  }
  for (const Group& group : form_groups(*movements, splits, settings)) {
    Result<Learnt> learnt = learn(group, analysis.synergies.joint_names, scale, settings);
    if (!learnt) return tl::make_unexpected(learnt.error());
    if (analysis.groups.empty()) {
      analysis.synergies.pre_grasp = std::move(learnt->synergies);
    } else {
      analysis.synergies.grasp.push_back(std::move(learnt->synergies));
    }
    analysis.groups.push_back(std::move(learnt->report));
  }
  std::vector<const Demonstration*> all;
  for (const Demonstration& demonstration : demonstrations) all.push_back(&demonstration);
  analysis.free_motion = free_motion_reference(std::move(all));
  return analysis;
}

}  // namespace opponens::analysis
