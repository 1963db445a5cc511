// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/coverage.hpp"
#include "analysis/human_likeness.hpp"
#include "analysis/intervals.hpp"
#include "analysis/phase_transition.hpp"
#include "analysis/recording_source.hpp"
#include "analysis/synergy_box.hpp"
#include "core/demonstration.hpp"
#include "core/result.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

struct JointRanges {
  Eigen::VectorXd lower;  ///< [n] rad
  Eigen::VectorXd upper;  ///< [n] rad
};

struct AnalysisSettings {
  double alpha = 0.05;                                                  ///< fraction left outside the n-box, in (0, 1)
  double beta = 0.05;                                                   ///< fraction of variance left out, in (0, 1)
  std::optional<TransitionRule> transition = TransitionRule::likeness;  ///< nullopt: no split, all samples per group
  BoxRoot box_root = BoxRoot::n;
  std::string group_by = "family";  ///< label that forms the groups; several with commas between
  int order = 0;  ///< 0: synergies of joint positions; 1: first-order synergies, of joint velocities (rad/s)
  std::optional<JointRanges> normalize_by;  ///< nullopt: radians; else x = q ./ (upper - lower)
  double resolution = 0.0087;               ///< rad, of the sensors (CyberGlove: 0.5 degrees)
  std::optional<int> min_window;            ///< samples on each side of a transition; default: effective dof + 1
  Normaliser normaliser = Normaliser::gaussian_overlap;
  std::uint64_t seed = 1;    ///< of the bootstrap
  int replicates = 200;      ///< of the bootstrap, >= 2
  double confidence = 0.95;  ///< of all intervals, in (0, 1)
};

/// Throws std::invalid_argument naming field, value and violated constraint.
void validate(const AnalysisSettings& settings);

TransitionSettings transition_settings(const AnalysisSettings& settings);

/// The group of a recording: the value of the label, or the values of several joined by "/" ("subject,object" gives
/// "1/scissors"). nullopt when it lacks one of them.
std::optional<std::string> group_of(const Demonstration& recording, const std::string& group_by);

struct GroupReport {
  std::string name;     ///< as in the synergy set
  std::string phase;    ///< "pre-grasp", "grasp" or "all"
  int samples = 0;      ///< rows pooled
  int recordings = 0;   ///< that contributed
  std::string cluster;  ///< what is resampled and left out: "subject" or "recording"
  int clusters = 0;
  int k = 0;                            ///< synergies kept
  Eigen::VectorXd cumulative_variance;  ///< [n]
  std::vector<Interval> intervals;      ///< [n] of cumulative_variance; empty with a single cluster
  BoxCoverage coverage;
};

struct TransitionReport {
  std::string demonstration;  ///< id, unique in its source
  std::string source;         ///< label "source"; empty: none
  Transition likeness;
  Transition changepoint;
  std::optional<double> likeness_error;  ///< found - known, fraction of the recording; simulated movements only
  std::optional<double> changepoint_error;
  std::vector<std::string> dropped_channels;
};

struct Analysis {
  SynergySet synergies;
  std::vector<GroupReport> groups;               ///< pre-grasp first, then synergies.grasp in its order
  std::vector<TransitionReport> transitions;     ///< one per movement, in the given order; empty without a split
  std::optional<LikenessReference> free_motion;  ///< from recordings labelled kind = "free", when there are any
};

/// Learns the synergies of section 4.1. Pre-grasp: all samples before the transition of all movements. Grasp: the
/// samples from the transition on, per value of the group_by label. Without a split the groups hold all samples and
/// the "pre-grasp" entry is their pool, both with phase "all". Recordings labelled kind = "free" are no movements to a
/// grasp; they give the human-likeness reference only. A group's clusters are its subjects, or its recordings when it
/// has one subject. First-order synergies (order 1) are learnt in the same way from the velocities of the same samples,
/// split where the positions are; an angle's resolution r then counts as r / (sqrt(2) d) for the median sampling step
/// d. The result does not depend on the order of the demonstrations, except that of `transitions`.
///
/// Failure, with a sentence naming the recording or group: invalid_input (no movements, a recording given twice, joints
/// that differ, a label absent, postures without time that are to be split or differentiated, samples not finite, time
/// that does not increase), too_few_samples (a recording too short to split; a group with no more samples than joints),
/// degenerate (nothing moves).
///
/// Every recording is read twice: for its transition and moments, then for the coverage of boxes that were learnt from
/// the others. Two batches of recordings are in memory at a time; of each movement about 10 n^2 numbers stay. The
/// result does not depend on the number of threads. reading.progress may throw to end it.
Result<Analysis> analyze(const RecordingSource& source, const AnalysisSettings& settings, const Reading& reading);

/// The same of recordings in memory, on one thread.
Result<Analysis> analyze(const std::vector<Demonstration>& demonstrations, const AnalysisSettings& settings);

}  // namespace opponens::analysis
