// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// One robot joint that copies a glove channel: q = gain * channel + offset, clipped to the limits. With `ranges` the
/// channel's range is laid linearly on the joint's instead, from its upper end down where gain is -1.
struct JointMapping {
  std::string joint;    ///< of the robot hand
  std::string channel;  ///< of the human hand (its joint name)
  double gain = 1.0;    ///< negative where the two count in opposite directions; with ranges 1 or -1
  double offset = 0.0;  ///< rad; with ranges 0
  bool ranges = false;
};

/// How a human hand drives a robot hand (hand.yaml, key "mapping"). Which part a mapping uses: MappingKind.
struct HandMapping {
  std::vector<JointMapping> copied;  ///< joint to joint in every mapping; recordings must have the channel
  /// Joint to joint where the joint is not found from fingertips.
  std::vector<JointMapping> direct;
  std::vector<std::string> fitted;                ///< robot joints that MappingKind::paper finds from fingertips
  std::map<std::string, std::string> fingertips;  ///< robot tip name -> human tip name
  /// MappingKind::paper: robot tip name -> robot tip of the finger from whose base it is measured; absent: its own. The
  /// thumb's measured from the index finger's keeps what both hands pinch.
  std::map<std::string, std::string> measured_from;
  Eigen::Matrix3d R_robot_human = Eigen::Matrix3d::Identity();  ///< human palm axes in the robot's palm frame
};

/// Throws InputError when the key is absent, or names a joint or tip that the hand.yaml does not list.
HandMapping load_hand_mapping(const std::filesystem::path& hand_yaml);

/// Range-to-range calibration of recordings whose zero is unknown: per channel, rad_out = gain * rad_in + offset.
/// Channels that are not listed are taken as they are.
struct ChannelCalibration {
  std::vector<std::string> channels;
  Eigen::VectorXd gain;
  Eigen::VectorXd offset;            ///< rad
  std::vector<std::string> still{};  ///< those of the channels that do not move: gain 0
};

/// rad: a channel whose observed range is smaller does not move. Three steps of a glove sensor of 0.5 degrees (that of
/// a CyberGlove), so that flicker by one step either way is not laid on a whole joint range.
inline constexpr double kStillRange = 0.026;

/// Maps each channel's observed range [1st, 99th percentile over the given recordings of one subject] to the human
/// hand's joint range, lower end on lower end. Percentiles interpolate between order statistics. A channel that does
/// not move (kStillRange) gets gain 0 and the joint position nearest to zero; channels that the human hand lacks are
/// left out.
ChannelCalibration calibrate_range(const std::vector<const Demonstration*>& recordings, const RobotModel& human);

}  // namespace opponens::robot
