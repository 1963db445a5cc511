// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"
#include "core/result.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// One robot joint that copies a glove channel: q = gain * channel + offset, clipped to the limits.
struct JointMapping {
  std::string joint;    ///< of the robot hand
  std::string channel;  ///< of the human hand (its joint name)
  double gain = 1.0;    ///< negative where the two count in opposite directions
  double offset = 0.0;  ///< rad
};

/// How a human hand drives a robot hand (hand.yaml, key "mapping"). --mapping paper: flexion joints copy, abduction and
/// thumb opposition come from fingertip positions (paper, section 3.2).
struct HandMapping {
  std::vector<JointMapping> copied;               ///< joint-to-joint part
  std::vector<std::string> fitted;                ///< robot joints found from fingertip positions
  std::map<std::string, std::string> fingertips;  ///< robot tip name -> human tip name
  /// Robot tip name -> robot tip of the finger from whose base it is measured; absent: its own. The thumb's measured
  /// from the index finger's keeps what both hands pinch.
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
  Eigen::VectorXd offset;  ///< rad
};

/// Maps each channel's observed range [1st, 99th percentile over the given recordings of one subject] to the human
/// hand's joint range; keeps the sign convention of the human hand model (flexion positive). channel_sign: -1 where the
/// recording counts the other way (absent: +1). Percentiles interpolate between order statistics. A channel that does
/// not move gets gain 0 and the joint position nearest to zero; channels that the human hand lacks are left out.
ChannelCalibration calibrate_range(const std::vector<const Demonstration*>& recordings, const RobotModel& human,
                                   const std::map<std::string, double>& channel_sign);

struct RetargetSettings {
  double smoothness = 0.1;  ///< weight of (q_t+1 - q_t) rad against fingertip residuals in cm
  double rest = 0.02;       ///< weight of (q - middle of the limits) rad, same unit: decides what tips leave open
  int max_iterations = 50;
};

struct Retargeted {
  Demonstration demonstration;    ///< of the robot hand, same time base, labels and origin
  double tip_residual_rms = 0.0;  ///< m, robot fingertips against scaled human ones
  double tip_residual_max = 0.0;  ///< m
  int clamped_samples = 0;        ///< samples in which a copied joint hit a limit
};

/// Maps a recording to the robot hand. The fitted joints of all samples are one least-squares problem (Ceres) inside
/// the joint limits, smooth over time: sum over samples and tips of |p - p*|^2 in cm^2, plus (smoothness dq)^2 over
/// neighbouring samples, plus (rest (q - middle))^2. The target of a robot tip, in its palm frame, is
///   p* = b_r + (l_r / l_h) R (p_h - b_h),
/// where p_h is the human tip in the human palm frame, b the base of the finger it is measured from (the last joint
/// origin on the way to the tip that no joint of the finger moves: the knuckle; for a thumb its first joint), l that
/// finger's length (joint to joint from the base to the tip), and R = R_robot_human. Hand joints that are neither
/// copied nor fitted stay at the position nearest to zero. One thread, deterministic. human: the parametric human hand,
/// of any size, since l_h divides it out (docs/algorithms/retarget.md). Failure: a channel, joint or tip is missing (not_found), a value is not finite
/// (invalid_input), a fitted joint moves no mapped tip (degenerate), the solver did not meet its tolerance
/// (not_converged).
Result<Retargeted> retarget(const Demonstration& recording, const ChannelCalibration& calibration,
                            const RobotModel& human, const RobotModel& hand, const HandMapping& mapping,
                            const RetargetSettings& settings);

}  // namespace opponens::robot
