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

/// One robot joint that copies a glove channel: q = sign * channel * gain + offset, clipped to the limits.
struct JointMapping {
  std::string joint;    ///< of the robot hand
  std::string channel;  ///< of the human hand (its joint name)
  double gain = 1.0;
  double offset = 0.0;  ///< rad
};

/// How a human hand drives a robot hand (hand.yaml, key "mapping"). --mapping paper: flexion joints copy, abduction and
/// thumb opposition come from fingertip positions (paper, section 3.2).
struct HandMapping {
  std::vector<JointMapping> copied;              ///< joint-to-joint part
  std::vector<std::string> fitted;               ///< robot joints found from fingertip positions
  std::map<std::string, std::string> fingertips; ///< robot tip name -> human tip name
};

HandMapping load_hand_mapping(const std::filesystem::path& hand_yaml);

/// Range-to-range calibration of recordings whose zero is unknown: per channel, rad_out = gain * rad_in + offset.
struct ChannelCalibration {
  std::vector<std::string> channels;
  Eigen::VectorXd gain;
  Eigen::VectorXd offset;  ///< rad
};

/// Maps each channel's observed range [1st, 99th percentile over the given recordings of one subject] to the human
/// hand's joint range; keeps the sign convention of the human hand model (flexion positive).
ChannelCalibration calibrate_range(const std::vector<const Demonstration*>& recordings, const RobotModel& human,
                                   const std::map<std::string, double>& channel_sign);

struct RetargetSettings {
  double smoothness = 0.1;      ///< weight of (q_t+1 - q_t) rad against fingertip residuals in cm
  int max_iterations = 50;
};

struct Retargeted {
  Demonstration demonstration;    ///< of the robot hand, same time base, labels and origin
  double tip_residual_rms = 0.0;  ///< m, robot fingertips against scaled human ones
  double tip_residual_max = 0.0;  ///< m
  int clamped_samples = 0;        ///< samples in which a copied joint hit a limit
};

/// Maps a recording to the robot hand. The fitted joints of all samples are one least-squares problem (Ceres) inside
/// the joint limits, smooth over time. human: the parametric human hand scaled to the wearer.
Result<Retargeted> retarget(const Demonstration& recording, const ChannelCalibration& calibration,
                            const RobotModel& human, const RobotModel& hand, const HandMapping& mapping,
                            const RetargetSettings& settings);

}  // namespace opponens::robot
