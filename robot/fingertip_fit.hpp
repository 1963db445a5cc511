// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "core/result.hpp"
#include "robot/finger.hpp"
#include "robot/retarget.hpp"

namespace opponens::robot {

/// A fitted joint as seen from a fingertip.
struct FittedJoint {
  int link = -1;         ///< the joint's child link: its origin lies on the axis
  Eigen::Vector3d axis;  ///< unit, in that link
  bool revolute = true;
};

/// Where a robot finger's tip should be.
struct TipTarget {
  Finger finger;
  std::vector<int> joints;             ///< indices into q of the fitted joints on the way to it, palm first
  std::map<int, FittedJoint> turning;  ///< by index into q
  Eigen::Matrix3Xd path;               ///< [3 x T] m, palm frame
};

/// The least-squares problem of retarget(), or of align_hands().
struct FingertipFit {
  std::vector<TipTarget> targets;
  std::vector<int> fitted;  ///< indices into q
  Eigen::MatrixXd rest;     ///< [fitted x T] rad
  Eigen::VectorXd time;     ///< [T] s; empty: the samples do not follow each other, each is fitted for itself
  bool cylindrical =
      true;  ///< tip errors in cylinder coordinates about the first fitted joint: for targets out of reach
  double tolerance = 1e-9;  ///< relative fall of the cost in three iterations that ends it
  bool shifted = false;     ///< one shift common to all targets is found too; then cylindrical must be false
};

/// Start values for fit_fingertips: cyclic coordinate descent, one fitted joint at a time, sample after sample, each
/// from the last one's where they follow each other. Exact for a finger with one fitted joint but for the small weights
/// of smoothness and rest.
void seed_positions(const RobotModel& hand, const FingertipFit& fit, Eigen::MatrixXd& q);

/// The fit falls apart where no joint moves the tips of two parts: with most hands finger by finger. Each part is
/// solved for itself, which is the same solution. A shifted fit is one part.
std::vector<FingertipFit> independent_parts(const FingertipFit& fit);

/// The problem of one sample.
FingertipFit sample_of(const FingertipFit& fit, Eigen::Index sample);

struct FitResult {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< m, common to all targets; zero unless it was asked for
  bool converged = true;                            ///< false: the iteration limit came before the tolerance
};

/// Moves the fitted joints' rows of q [d x T] from where they are so that the tips follow their targets. Failure: the
/// solver broke down (not_converged).
Result<FitResult> fit_fingertips(const RobotModel& hand, const FingertipFit& fit, const RetargetSettings& settings,
                                 Eigen::MatrixXd& q);

}  // namespace opponens::robot
