// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/retarget.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/require.hpp"
#include "robot/joint_mapping.hpp"
#include "robot/tip_targets.hpp"

namespace opponens::robot {

namespace {

constexpr const char* kMayBeAbsent = "M_ABD";
constexpr double kTolerance = 1e-5;  ///< of the cost where all joints of a finger are fitted

/// Both hands, and how the one drives the other.
struct Task {
  const RobotModel& human;
  const RobotModel& hand;
  const HandMapping& mapping;
  const RetargetSettings& settings;
  std::vector<FingerPair> fingers{};
  Eigen::MatrixXd q_human{};  ///< [d x T] rad
};

void validate(const Demonstration& recording, const RetargetSettings& settings) {
  require(recording.q_h.rows() > 0 && recording.q_h.rows() == recording.time.size() &&
              recording.q_h.cols() == static_cast<Eigen::Index>(recording.joint_names.size()),
          [&] { return "recording '" + recording.id + "': sizes of time, joint names and samples do not agree"; });
  for (Eigen::Index t = 1; t < recording.time.size(); ++t) {
    require(recording.time[t] > recording.time[t - 1],
            [&] { return "recording '" + recording.id + "': time does not increase at sample " + std::to_string(t); });
  }
  require(
      settings.velocity >= 0.0 && settings.acceleration >= 0.0 && settings.rest >= 0.0 && settings.max_iterations > 0,
      "retarget: velocity, acceleration and rest must not be negative, max_iterations must be positive");
}

Result<std::vector<int>> named_joints(const RobotModel& hand, const std::vector<std::string>& names) {
  std::vector<int> joints;
  for (const std::string& name : names) {
    const std::optional<int> joint = index_of(hand.joint_names(), name);
    if (!joint) return failure(FailureCode::not_found, "the robot hand has no joint '" + name + "'");
    joints.push_back(*joint);
  }
  return joints;
}

/// What the fitted joints shall do; for MappingKind::joint only the targets, since nothing is fitted.
Result<FingertipFit> fit_of(const Task& task) {
  FingertipFit fit;
  if (task.settings.mapping == MappingKind::paper) {
    const auto fitted = named_joints(task.hand, task.mapping.fitted);
    if (!fitted) return tl::make_unexpected(fitted.error());
    fit.fitted = *fitted;
    auto targets = finger_targets(task.human, task.q_human, task.hand, task.mapping, task.fingers, *fitted);
    if (!targets) return tl::make_unexpected(targets.error());
    fit.targets = std::move(*targets);
    return fit;
  }
  if (task.fingers.empty()) {
    if (task.settings.mapping == MappingKind::joint) return fit;
    return failure(FailureCode::degenerate, "the mapping names no fingertip");
  }
  const auto alignment = task.settings.alignment ? Result<HandAlignment>(*task.settings.alignment)
                                                 : align_hands(task.human, task.hand, task.mapping);
  if (!alignment) return tl::make_unexpected(alignment.error());
  fit.targets = aligned_targets(task.human, task.q_human, *alignment, task.mapping.R_robot_human, task.fingers);
  fit.cylindrical = false;
  fit.tolerance = kTolerance;
  if (task.settings.mapping == MappingKind::fingertip) fit.fitted = moving_joints(task.fingers);
  return fit;
}

/// Channels that the recording lacks, though the mapping uses them; see retarget().
Result<std::vector<std::string>> absent_channels(const Demonstration& recording, const Task& task) {
  std::set<std::string> required;
  std::set<std::string> used;
  for (const JointMapping& copy : task.mapping.copied) required.insert(copy.channel);
  if (task.settings.mapping != MappingKind::paper) {
    for (const JointMapping& copy : task.mapping.direct) required.insert(copy.channel);
  }
  for (const FingerPair& pair : task.fingers) {
    for (const int joint : pair.human.moved_by) used.insert(task.human.joint_names()[static_cast<std::size_t>(joint)]);
  }
  if (task.settings.mapping != MappingKind::joint) required.insert(used.begin(), used.end());
  used.insert(required.begin(), required.end());
  std::vector<std::string> absent;
  for (const std::string& channel : used) {
    if (index_of(recording.joint_names, channel)) continue;
    absent.push_back(channel);
    if (channel == kMayBeAbsent || !required.contains(channel)) continue;
    return failure(FailureCode::not_found,
                   "recording '" + recording.id + "' has no channel '" + channel + "', which this mapping needs");
  }
  return absent;
}

/// Where the joints are before the fit: copied joints at their channels, and so the direct ones but for the paper's
/// mapping, which has its fitted ones in the middle.
Result<Eigen::MatrixXd> start_positions(const Task& task, BoolMatrix& clamped) {
  const RobotModel& hand = task.hand;
  const bool paper = task.settings.mapping == MappingKind::paper;
  Eigen::MatrixXd q = hand.clip(Eigen::VectorXd::Zero(hand.dof())).replicate(1, task.q_human.cols());
  clamped = BoolMatrix::Constant(q.rows(), q.cols(), false);
  std::vector<JointMapping> copies = task.mapping.copied;
  if (!paper) copies.insert(copies.end(), task.mapping.direct.begin(), task.mapping.direct.end());
  if (const auto copied = copy_joints(task.human, task.q_human, hand, copies, q, clamped); !copied) {
    return tl::make_unexpected(copied.error());
  }
  return q;
}

void mark_limits(const RobotModel& hand, const std::vector<int>& fitted, const Eigen::MatrixXd& q,
                 BoolMatrix& clamped) {
  for (const int joint : fitted) {
    clamped.row(joint) = q.row(joint).array() <= hand.lower()[joint] || q.row(joint).array() >= hand.upper()[joint];
  }
}

void measure(const Task& task, const FingertipFit& fit, const Eigen::MatrixXd& q, const BoolMatrix& clamped,
             Retargeted& result) {
  const auto samples = static_cast<double>(q.cols());
  result.tip_rms.resize(static_cast<Eigen::Index>(fit.targets.size()));
  for (std::size_t f = 0; f < fit.targets.size(); ++f) {
    const TipTarget& target = fit.targets[f];
    const Eigen::VectorXd distance = (tip_path(task.hand, target.finger, q) - target.path).colwise().norm();
    result.tips.push_back(task.fingers[f].tip);
    result.tip_rms[static_cast<Eigen::Index>(f)] = std::sqrt(distance.squaredNorm() / samples);
    result.tip_residual_max = std::max(result.tip_residual_max, distance.maxCoeff());
  }
  if (!result.tips.empty()) {
    result.tip_residual_rms = std::sqrt(result.tip_rms.squaredNorm() / static_cast<double>(result.tips.size()));
  }
  const PlanningGroup& group = task.hand.hand();
  const BoolMatrix ours = clamped.middleRows(group.first, group.count);
  result.clamped_share = ours.cast<double>().rowwise().mean();
  result.clamped_samples = static_cast<int>(ours.colwise().any().count());
}

}  // namespace

RetargetSettings default_settings(MappingKind mapping) {
  RetargetSettings settings;
  settings.mapping = mapping;
  if (mapping == MappingKind::fingertip) {
    settings.velocity = 0.0;
    settings.acceleration = 0.005;
    settings.rest = 0.2;
    settings.max_iterations = 500;
  }
  return settings;
}

Result<Retargeted> retarget(const Demonstration& recording, const ChannelCalibration& calibration,
                            const RobotModel& human, const RobotModel& hand, const HandMapping& mapping,
                            const RetargetSettings& settings) {
  validate(recording, settings);
  Task task{human, hand, mapping, settings};
  auto q_human = human_positions(recording, calibration, human);
  if (!q_human) return tl::make_unexpected(q_human.error());
  task.q_human = std::move(*q_human);
  auto fingers = mapped_fingers(human, hand, mapping);
  if (!fingers) return tl::make_unexpected(fingers.error());
  task.fingers = std::move(*fingers);
  const auto absent = absent_channels(recording, task);
  if (!absent) return tl::make_unexpected(absent.error());
  Result<FingertipFit> fit = fit_of(task);
  if (!fit) return tl::make_unexpected(fit.error());
  BoolMatrix clamped;
  Result<Eigen::MatrixXd> q = start_positions(task, clamped);
  if (!q) return tl::make_unexpected(q.error());

  if (!settings.postures) fit->time = recording.time;
  fit->rest = (*q)(fit->fitted, Eigen::all);
  if (settings.mapping == MappingKind::paper) {
    fit->rest = (0.5 * (hand.lower() + hand.upper()))(fit->fitted).replicate(1, q->cols());
    (*q)(fit->fitted, Eigen::all) = fit->rest;
    seed_positions(hand, *fit, *q);
  }
  const auto fitted = fit_fingertips(hand, *fit, settings, *q);
  if (!fitted) {
    return failure(fitted.error().code, "recording '" + recording.id + "': " + fitted.error().detail);
  }
  mark_limits(hand, fit->fitted, *q, clamped);

  Retargeted result;
  result.assumed = *absent;
  result.converged = fitted->converged;
  result.demonstration = recording;
  result.demonstration.joint_names = hand.hand().joint_names;
  result.demonstration.q_h = q->middleRows(hand.hand().first, hand.hand().count).transpose();
  measure(task, *fit, *q, clamped, result);
  return result;
}

}  // namespace opponens::robot
