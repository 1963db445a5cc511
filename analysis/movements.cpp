// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/movements.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "analysis/statistics.hpp"
#include "analysis/velocity.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

/// One recording, or why it cannot be used.
struct Found {
  std::optional<Failure> failure;
  std::optional<FreeMotion> free_motion;
  Movement movement;
  std::optional<TransitionReport> transition;
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

Result<TransitionReport> find_transition(const Demonstration& demonstration, const AnalysisSettings& settings) {
  const Result<TransitionCurves> curves = transition_curves(demonstration, transition_settings(settings));
  if (!curves) return tl::make_unexpected(curves.error());
  TransitionReport report;
  report.demonstration = demonstration.id;
  report.source = label(demonstration, "source");
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

/// Why a movement cannot be analysed as it is asked for.
std::optional<Failure> unfit(const Demonstration& recording, const std::string& group,
                             const AnalysisSettings& settings) {
  const std::string name = "recording " + recording.id;
  if (group.empty()) {
    return Failure{FailureCode::invalid_input, name + " has no label '" + settings.group_by + "' to group by"};
  }
  if (label(recording, "kind") != "postures") return std::nullopt;
  if (settings.transition) {
    return Failure{FailureCode::invalid_input, name +
                                                   " holds postures without time: it has no phases to split; analyse " +
                                                   "such recordings with --phase none"};
  }
  if (settings.order == 1) {
    return Failure{FailureCode::invalid_input, name + " holds postures without time: they have no velocities"};
  }
  return std::nullopt;
}

/// Everything about one recording that does not need another.
Found examine(const Demonstration& recording, const Movements& all, const AnalysisSettings& settings) {
  Found found;
  found.movement.id = recording.id;
  found.movement.source = label(recording, "source");
  found.failure = fault(recording, all.joint_names);
  if (found.failure) return found;
  if (is_free_motion(recording)) {
    found.free_motion = free_motion(recording);
    return found;
  }
  Movement& movement = found.movement;
  movement.subject = label(recording, "subject");
  movement.group = group_of(recording, settings.group_by).value_or("");
  movement.weight = recording.weight;
  movement.samples = static_cast<int>(recording.q_h.rows());
  found.failure = unfit(recording, movement.group, settings);
  if (found.failure) return found;
  const Eigen::MatrixXd values = analysed_values(recording, settings.order);
  if (settings.order == 1) movement.noise_gain = velocity_noise_gain(recording.time);
  if (settings.transition) {
    Result<TransitionReport> report = find_transition(recording, settings);
    if (!report) {
      found.failure = report.error();
      return found;
    }
    movement.begin =
        *settings.transition == TransitionRule::likeness ? report->likeness.index : report->changepoint.index;
    movement.before = scaled(moments(values.topRows(movement.begin), movement.weight), all.scale);
    found.transition = std::move(*report);
  }
  const Eigen::Index rest = movement.samples - movement.begin;
  movement.after = scaled(moments(values.bottomRows(rest), movement.weight), all.scale);
  return found;
}

/// Recordings given twice would be taken for independent ones. Two sources may use the same name.
std::optional<Failure> repetition(const std::vector<Found>& found) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const Found& one : found) {
    const auto& [id, source] = std::pair(one.movement.id, one.movement.source);
    if (seen.insert({source, id}).second) continue;
    return Failure{FailureCode::invalid_input,
                   "recording " + id + " is given twice" + (source.empty() ? "" : " (source " + source + ")")};
  }
  return std::nullopt;
}

Eigen::VectorXd scale_of(const AnalysisSettings& settings, Eigen::Index joints) {
  if (!settings.normalize_by) return Eigen::VectorXd::Ones(joints);
  require(settings.normalize_by->lower.size() == joints, "analyze: normalize_by needs one range per joint");
  return settings.normalize_by->upper - settings.normalize_by->lower;
}

double median_noise_gain(const std::vector<Movement>& movements) {
  std::vector<double> gains;
  for (const Movement& movement : movements) gains.push_back(movement.noise_gain);
  const auto middle = gains.begin() + static_cast<std::ptrdiff_t>(gains.size() / 2);
  std::nth_element(gains.begin(), middle, gains.end());
  return *middle;
}

}  // namespace

std::optional<std::string> group_of(const Demonstration& recording, const std::string& group_by) {
  std::string name;
  std::size_t begin = 0;
  while (begin <= group_by.size()) {
    const std::size_t end = std::min(group_by.find(',', begin), group_by.size());
    const std::string value = label(recording, group_by.substr(begin, end - begin));
    if (value.empty()) return std::nullopt;
    name += (begin == 0 ? "" : "/") + value;
    begin = end + 1;
  }
  return name;
}

Eigen::MatrixXd analysed_values(const Demonstration& recording, int order) {
  return order == 0 ? recording.q_h : joint_velocities(recording.time, recording.q_h);
}

Result<Movements> read_movements(const RecordingSource& source, const AnalysisSettings& settings,
                                 const Reading& reading) {
  Movements result;
  result.joint_names = source.read(0).joint_names;
  result.scale = scale_of(settings, static_cast<Eigen::Index>(result.joint_names.size()));
  std::vector<std::size_t> indices(source.count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::vector<Found> found(source.count);
  for_each_recording(source, indices, reading, [&](std::size_t place, const Demonstration& recording) {
    found[place] = examine(recording, result, settings);
    found[place].movement.index = place;
    return !found[place].failure;
  });
  const auto failed =
      std::find_if(found.begin(), found.end(), [](const Found& one) { return one.failure.has_value(); });
  if (failed != found.end()) return tl::make_unexpected(*failed->failure);
  if (const auto twice = repetition(found)) return tl::make_unexpected(*twice);
  for (Found& one : found) {
    if (one.free_motion) {
      result.free_motions.push_back(std::move(*one.free_motion));
      continue;
    }
    if (one.transition) result.transitions.push_back(std::move(*one.transition));
    result.movements.push_back(std::move(one.movement));
  }
  if (result.movements.empty()) return failure(FailureCode::invalid_input, "no movements to analyze");
  result.resolution = settings.resolution * median_noise_gain(result.movements);
  std::stable_sort(result.movements.begin(), result.movements.end(), [](const Movement& a, const Movement& b) {
    return std::pair(a.id, a.source) < std::pair(b.id, b.source);
  });
  return result;
}

}  // namespace opponens::analysis
