// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/fingertip_fit.hpp"

namespace opponens::robot {

/// Residuals of all tips of a fit in one sample, 3 for each; their squares sum to |100 weight (p - shift - p*)|^2, for
/// tip p and target p* in the palm frame: lengths in cm, so that weights in rad compare with them. Derivatives by
/// RobotModel::point_jacobian. hand and fit must outlive it.
class TipResiduals {
 public:
  /// q: [d] where the joints are that are not fitted.
  TipResiduals(const RobotModel& hand, const FingertipFit& fit, Eigen::VectorXd q, Eigen::Index sample, double weight);

  /// x: [fitted]. shift: [3] m, or null for none. residuals: [3 F]. jacobian: [3 F x fitted] row by row, or null. Not
  /// for two threads at once.
  void evaluate(const double* x, const double* shift, double* residuals, double* jacobian) const;
  /// The derivative by the shift, [3 F x 3] row by row; for plain, not cylindrical errors.
  void shift_jacobian(double* jacobian) const;

 private:
  const RobotModel& hand_;
  const FingertipFit& fit_;
  mutable Eigen::VectorXd q_;  // scratch
  mutable std::vector<Eigen::Isometry3d> X_RL_;
  Eigen::Index sample_;
  double weight_;
};

}  // namespace opponens::robot
