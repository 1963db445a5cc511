// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"
#include "core/result.hpp"
#include "robot/hand_mapping.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// m, of models/human_hand: between the means of 19.4 cm (standard deviation 1.0) of men and 18.0 cm (1.0) of women in
/// Gordon and others 1989, "1988 Anthropometric Survey of U.S. Army Personnel", Natick/TR-89/044.
inline constexpr double kHumanHandLength = 0.19;

enum class MappingKind {
  joint,      ///< joint to joint: copied and direct
  fingertip,  ///< every joint that moves a mapped fingertip is found from fingertip positions
  paper,      ///< section 3.2: flexion is copied, abduction and thumb opposition come from fingertip positions
};

/// One similarity for the whole hand: human palm coordinates p_h become p* = offset + scale R_robot_human p_h in the
/// robot's palm frame. It keeps all relations between the fingertips: what the human hand pinches, the robot pinches.
struct HandAlignment {
  double scale = 1.0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< m
};

/// scale: the mean over the mapped fingers of (robot finger length) / (human finger length), both joint to joint from
/// base to tip. offset: the one with which the robot's fingertips come nearest to 100 postures of the human hand, drawn
/// uniformly from its joint ranges (always the same), in the sense of retarget()'s fingertip problem without
/// smoothness. human: of the reference size, so that scale belongs to the robot hand and a large and a small wearer who
/// hold the same object give the same robot opening. Failure: not_found (a tip, joint or channel), degenerate (no
/// fingertip is mapped), not_converged.
Result<HandAlignment> align_hands(const RobotModel& human, const RobotModel& hand, const HandMapping& mapping);

/// Weights of the cost, which is a time average of squares: 1 cm of one fingertip counts 1. They act on time
/// derivatives, so they do not depend on the sampling rate.
struct RetargetSettings {
  MappingKind mapping = MappingKind::paper;
  double velocity = 0.002;    ///< cm s / rad
  double acceleration = 0.0;  ///< cm s^2 / rad
  double rest = 0.02;         ///< cm / rad, of the deviation from the rest posture: decides what tips leave open
  int max_iterations = 50;
  /// The samples are postures that do not follow each other: each is mapped for itself, without smoothness.
  bool postures = false;
  std::optional<HandAlignment> alignment{};  ///< of joint and fingertip; absent: align_hands with the given human hand
};

/// What the command uses. fingertip: acceleration 0.005 (motions of a joint that moves its tip by 10 cm / rad pass up
/// to about 7 Hz) and rest 0.2.
RetargetSettings default_settings(MappingKind mapping);

struct Retargeted {
  Demonstration demonstration;    ///< of the robot hand, same time base, labels and origin
  std::vector<std::string> tips;  ///< [F] names of the mapped robot tips; none where the mapping names no tip
  Eigen::VectorXd tip_rms;        ///< [F] m, robot fingertip against its target
  double tip_residual_rms = 0.0;  ///< m, of all tips
  double tip_residual_max = 0.0;  ///< m
  Eigen::VectorXd clamped_share;  ///< [n] share of samples in which the joint was held at a limit
  int clamped_samples = 0;        ///< samples in which any joint was
  /// Channels without a recording, taken where the human hand has them at rest (nearest to zero): see retarget().
  std::vector<std::string> assumed{};
  bool converged = true;  ///< false: the solver stopped at its iteration limit
};

/// Maps a recording to the robot hand. A copied joint is held at a limit where its value lies beyond; a fitted one
/// where the solution lies on it. Hand joints that are neither copied nor fitted stay at the position nearest to zero.
///
/// The fitted joints of all samples are one sparse least-squares problem (Ceres, sparse Cholesky) inside the joint
/// limits. Minimised is the time average of
///   sum over tips |p - p*|^2 + |velocity q'|^2 + |acceleration q''|^2 + |rest (q - q_rest)|^2,
/// lengths in cm, by differences over the given times (each sample stands for half the time to its neighbours). q_rest
/// is the joint-to-joint posture (fingertip) or the middle of the limits (paper).
///
/// Target p* of a robot tip in its palm frame:
/// - joint, fingertip: the alignment's, of the mapped human tip; joint only measures residuals against it.
/// - paper: p* = b_r + (l_r / l_h) R (p_h - b_h), p_h the human tip, b the base of the finger it is measured from (the
///   last joint origin on the way to the tip that no joint of the finger moves: the knuckle; for a thumb its first
///   joint), l that finger's length and R = R_robot_human. A human hand of another size divides out.
///
/// A recording must have the channels of the copied joints, for joint and fingertip those of the direct ones, and for
/// fingertip and paper every channel that moves a mapped human tip; but M_ABD, which many gloves do not measure (theirs
/// are angles between neighbours, and the middle finger is the one they start from), may be absent. So may, for joint,
/// channels that only its residuals depend on. The result names them.
///
/// One thread, deterministic. human: the parametric human hand at the wearer's size. Mimic joints follow their drivers,
/// which are fitted through them. Failure: a channel, joint or tip is missing (not_found), a value is not finite
/// (invalid_input), a fitted joint moves no mapped tip, or the mapping needs fingertips and names none (degenerate),
/// the solver broke down (not_converged).
Result<Retargeted> retarget(const Demonstration& recording, const ChannelCalibration& calibration,
                            const RobotModel& human, const RobotModel& hand, const HandMapping& mapping,
                            const RetargetSettings& settings);

}  // namespace opponens::robot
