// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "robot/fingertip_fit.hpp"
#include "robot/hand_mapping.hpp"

namespace opponens::robot {

namespace {

std::optional<int> index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

const SurfacePoint* find_tip(const RobotModel& hand, const std::string& name) {
  const auto& tips = hand.description().tips;
  const auto found = std::find_if(tips.begin(), tips.end(), [&](const SurfacePoint& tip) { return tip.name == name; });
  return found == tips.end() ? nullptr : &*found;
}

/// The human joint positions of all samples [d x T], calibrated; channels not recorded stay nearest to zero.
Result<Eigen::MatrixXd> human_positions(const Demonstration& recording, const ChannelCalibration& calibration,
                                        const RobotModel& human) {
  Eigen::MatrixXd q = human.clip(Eigen::VectorXd::Zero(human.dof())).replicate(1, recording.q_h.rows());
  for (int i = 0; i < human.dof(); ++i) {
    const std::string& channel = human.joint_names()[static_cast<std::size_t>(i)];
    const std::optional<int> column = index_of(recording.joint_names, channel);
    if (!column) continue;
    const std::optional<int> line = index_of(calibration.channels, channel);
    const double gain = line ? calibration.gain[*line] : 1.0;
    const double offset = line ? calibration.offset[*line] : 0.0;
    q.row(i) = (gain * recording.q_h.col(*column).array() + offset).transpose();
  }
  if (!q.allFinite()) {
    return failure(FailureCode::invalid_input, "recording '" + recording.id + "' has a value that is not finite");
  }
  return q;
}

/// Copies the joint-to-joint part into q [d x T] of the robot hand and counts the samples that hit a limit.
Result<int> copy_joints(const Demonstration& recording, const RobotModel& human, const Eigen::MatrixXd& q_human,
                        const RobotModel& hand, const HandMapping& mapping, Eigen::MatrixXd& q) {
  Eigen::Array<bool, Eigen::Dynamic, 1> clamped = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(q.cols(), false);
  for (const JointMapping& copy : mapping.copied) {
    const std::optional<int> joint = index_of(hand.joint_names(), copy.joint);
    const std::optional<int> channel = index_of(human.joint_names(), copy.channel);
    if (!joint) return failure(FailureCode::not_found, "the robot hand has no joint '" + copy.joint + "'");
    if (!channel) return failure(FailureCode::not_found, "the human hand has no joint '" + copy.channel + "'");
    if (!index_of(recording.joint_names, copy.channel)) {
      return failure(FailureCode::not_found, "recording '" + recording.id + "' has no channel '" + copy.channel +
                                                 "', which joint '" + copy.joint + "' copies");
    }
    const Eigen::ArrayXd wanted = copy.gain * q_human.row(*channel).transpose().array() + copy.offset;
    const double low = hand.lower()[*joint];
    const double high = hand.upper()[*joint];
    q.row(*joint) = wanted.max(low).min(high).transpose();
    clamped = clamped || wanted < low || wanted > high;
  }
  return static_cast<int>(clamped.count());
}

Result<std::vector<int>> fitted_joints(const RobotModel& hand, const HandMapping& mapping) {
  std::vector<int> fitted;
  for (const std::string& name : mapping.fitted) {
    const std::optional<int> joint = index_of(hand.joint_names(), name);
    if (!joint) return failure(FailureCode::not_found, "the robot hand has no joint '" + name + "'");
    fitted.push_back(*joint);
  }
  return fitted;
}

/// The fitted joints between palm and tip. A joint that only drives others (mimic) is not among them and stays
/// unfitted.
void find_fitted_joints(const RobotModel& hand, const std::vector<int>& fitted, TipTarget& target) {
  for (int link = target.finger.link; link != hand.palm() && hand.links()[static_cast<std::size_t>(link)].joint >= 0;) {
    const Joint& joint =
        hand.description().joints[static_cast<std::size_t>(hand.links()[static_cast<std::size_t>(link)].joint)];
    const std::optional<int> index = index_of(hand.joint_names(), joint.name);
    if (index && std::find(fitted.begin(), fitted.end(), *index) != fitted.end()) {
      target.joints.insert(target.joints.begin(), *index);
      target.turning[*index] = {joint.child, joint.axis, joint.type == JointType::revolute};
    }
    link = joint.parent;
  }
}

struct FingerPair {
  Finger robot;
  Finger human;
};

Result<std::map<std::string, FingerPair>> mapped_fingers(const RobotModel& human, const RobotModel& hand,
                                                         const HandMapping& mapping) {
  std::map<std::string, FingerPair> fingers;
  for (const auto& [robot_name, human_name] : mapping.fingertips) {
    const SurfacePoint* robot_tip = find_tip(hand, robot_name);
    const SurfacePoint* human_tip = find_tip(human, human_name);
    if (!robot_tip) return failure(FailureCode::not_found, "the robot hand has no tip '" + robot_name + "'");
    if (!human_tip) return failure(FailureCode::not_found, "the human hand has no tip '" + human_name + "'");
    fingers[robot_name] = {finger_of(hand, *robot_tip), finger_of(human, *human_tip)};
  }
  return fingers;
}

/// p* = b_r + (l_r / l_h) R (p_h - b_h) for every mapped tip.
Result<std::vector<TipTarget>> tip_targets(const RobotModel& human, const Eigen::MatrixXd& q_human,
                                           const RobotModel& hand, const HandMapping& mapping,
                                           const std::vector<int>& fitted) {
  const auto fingers = mapped_fingers(human, hand, mapping);
  if (!fingers) return tl::make_unexpected(fingers.error());
  std::vector<TipTarget> targets;
  for (const auto& [name, pair] : *fingers) {
    const auto other = mapping.measured_from.find(name);
    const auto from = fingers->find(other == mapping.measured_from.end() ? name : other->second);
    if (from == fingers->end()) {
      return failure(FailureCode::not_found, "tip '" + name + "' is measured from '" + other->second + "': not mapped");
    }
    const Finger& ours = from->second.robot;
    const Finger& theirs = from->second.human;
    const Eigen::Matrix3d turned = (ours.length / theirs.length) * mapping.R_robot_human;
    TipTarget target{pair.robot, {}, {}, {}};
    target.path = (turned * (tip_path(human, pair.human, q_human).colwise() - theirs.base)).colwise() + ours.base;
    find_fitted_joints(hand, fitted, target);
    targets.push_back(std::move(target));
  }
  for (const int joint : fitted) {
    const bool used = std::any_of(targets.begin(), targets.end(), [&](const TipTarget& target) {
      return std::find(target.joints.begin(), target.joints.end(), joint) != target.joints.end();
    });
    if (!used) {
      return failure(FailureCode::degenerate, "joint '" + hand.joint_names()[static_cast<std::size_t>(joint)] +
                                                  "' is fitted, but moves no mapped fingertip");
    }
  }
  return targets;
}

void measure_residuals(const RobotModel& hand, const std::vector<TipTarget>& targets, const Eigen::MatrixXd& q,
                       Retargeted& result) {
  double sum = 0.0;
  double count = 0.0;
  for (const TipTarget& target : targets) {
    const Eigen::VectorXd distance = (tip_path(hand, target.finger, q) - target.path).colwise().norm();
    sum += distance.squaredNorm();
    count += static_cast<double>(distance.size());
    result.tip_residual_max = std::max(result.tip_residual_max, distance.maxCoeff());
  }
  result.tip_residual_rms = count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

Result<Retargeted> retarget(const Demonstration& recording, const ChannelCalibration& calibration,
                            const RobotModel& human, const RobotModel& hand, const HandMapping& mapping,
                            const RetargetSettings& settings) {
  require(recording.q_h.rows() > 0 && recording.q_h.rows() == recording.time.size() &&
              recording.q_h.cols() == static_cast<Eigen::Index>(recording.joint_names.size()),
          [&] { return "recording '" + recording.id + "': sizes of time, joint names and samples do not agree"; });
  require(settings.smoothness >= 0.0 && settings.rest >= 0.0 && settings.max_iterations > 0,
          "retarget: smoothness and rest must not be negative, max_iterations must be positive");
  const Result<Eigen::MatrixXd> q_human = human_positions(recording, calibration, human);
  if (!q_human) return tl::make_unexpected(q_human.error());
  const Result<std::vector<int>> fitted = fitted_joints(hand, mapping);
  if (!fitted) return tl::make_unexpected(fitted.error());
  const Result<std::vector<TipTarget>> targets = tip_targets(human, *q_human, hand, mapping, *fitted);
  if (!targets) return tl::make_unexpected(targets.error());

  Eigen::MatrixXd q = hand.clip(Eigen::VectorXd::Zero(hand.dof())).replicate(1, q_human->cols());
  for (const int joint : *fitted) q.row(joint).setConstant(0.5 * (hand.lower()[joint] + hand.upper()[joint]));
  const Result<int> clamped = copy_joints(recording, human, *q_human, hand, mapping, q);
  if (!clamped) return tl::make_unexpected(clamped.error());
  if (std::optional<Failure> failed = fit_fingertips(hand, *targets, *fitted, settings, q)) {
    failed->detail = "recording '" + recording.id + "': " + failed->detail;
    return tl::make_unexpected(*failed);
  }

  Retargeted result;
  result.demonstration = recording;
  result.demonstration.joint_names = hand.hand().joint_names;
  result.demonstration.q_h = q.middleRows(hand.hand().first, hand.hand().count).transpose();
  result.clamped_samples = *clamped;
  measure_residuals(hand, *targets, q, result);
  return result;
}

}  // namespace opponens::robot
