// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/joint_mapping.hpp"

#include <algorithm>

namespace opponens::robot {

namespace {

/// q = gain * channel + offset of a copy, its ranges resolved.
struct Line {
  double gain = 1.0;
  double offset = 0.0;
};

Line line_of(const JointMapping& copy, const RobotModel& human, int channel, const RobotModel& hand, int joint) {
  if (!copy.ranges) return {copy.gain, copy.offset};
  const double gain =
      copy.gain * (hand.upper()[joint] - hand.lower()[joint]) / (human.upper()[channel] - human.lower()[channel]);
  return {gain, (gain > 0.0 ? hand.lower()[joint] : hand.upper()[joint]) - gain * human.lower()[channel]};
}

}  // namespace

std::optional<int> index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

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

Result<std::monostate> copy_joints(const RobotModel& human, const Eigen::MatrixXd& q_human, const RobotModel& hand,
                                   const std::vector<JointMapping>& copies, Eigen::MatrixXd& q, BoolMatrix& clamped) {
  for (const JointMapping& copy : copies) {
    const std::optional<int> joint = index_of(hand.joint_names(), copy.joint);
    const std::optional<int> channel = index_of(human.joint_names(), copy.channel);
    if (!joint) return failure(FailureCode::not_found, "the robot hand has no joint '" + copy.joint + "'");
    if (!channel) return failure(FailureCode::not_found, "the human hand has no joint '" + copy.channel + "'");
    const Line line = line_of(copy, human, *channel, hand, *joint);
    const Eigen::ArrayXd wanted = line.gain * q_human.row(*channel).transpose().array() + line.offset;
    const double low = hand.lower()[*joint];
    const double high = hand.upper()[*joint];
    q.row(*joint) = wanted.max(low).min(high).transpose();
    clamped.row(*joint) = (wanted < low || wanted > high).transpose();
  }
  return std::monostate();
}

}  // namespace opponens::robot
