// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The Newton part of ArmKinematics: from an analytic solution for ideal axes to one of the axes as printed in the URDF.
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/SVD>

#include "robot/inverse_kinematics.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd angle_axis(Eigen::Quaterniond(R).normalized());
  return angle_axis.axis() * angle_axis.angle();
}

}  // namespace

/// Newton step of the pose error at q; a least-squares step where the Jacobian is singular.
ArmKinematics::Vector6d ArmKinematics::step(const Isometry3d& X_RH, const Vector6d& q, double& residual) const {
  std::array<Vector3d, 6> axis;
  std::array<Vector3d, 6> origin;
  Isometry3d X = Isometry3d::Identity();
  for (std::size_t i = 0; i < 6; ++i) {
    X = X * joints_[i].X_PJ;
    origin[i] = X.translation();
    axis[i] = X.linear() * joints_[i].axis;
    X.linear() = X.linear() * Eigen::AngleAxisd(q[static_cast<Eigen::Index>(i)], joints_[i].axis).toRotationMatrix();
  }
  X = X * X_6H_;
  Vector6d error;
  error << rotation_vector(X_RH.linear() * X.linear().transpose()), X_RH.translation() - X.translation();
  residual = std::max(error.head<3>().norm(), error.tail<3>().norm());
  if (residual < 0.01 * kPoseTolerance) return Vector6d::Zero();
  Eigen::Matrix<double, 6, 6> jacobian;
  for (std::size_t i = 0; i < 6; ++i) {
    jacobian.col(static_cast<Eigen::Index>(i)) << axis[i], axis[i].cross(X.translation() - origin[i]);
  }
  Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>> svd(jacobian, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(1e-7);
  return svd.solve(error);
}

/// Newton iterations from q, kept short; returns the residual reached (max of m and rad).
double ArmKinematics::refine(const Isometry3d& X_RH, Vector6d& q) const {
  double best = 0.0;
  Vector6d change = step(X_RH, q, best);
  for (int iteration = 0; iteration < 12 && change.norm() > 0.0; ++iteration) {
    const Vector6d next = q + change;
    double residual = 0.0;
    const Vector6d next_change = step(X_RH, next, residual);
    if (!(residual < best) || (next - q).norm() > 0.01) break;  // no progress, or another branch
    q = next;
    best = residual;
    change = next_change;
  }
  return best;
}

/// Refines, from beside a singularity where need be: the root there moves by the square root of the digits missing.
bool ArmKinematics::settle(const Isometry3d& X_RH, Vector6d& q) const {
  if (refine(X_RH, q) < kPoseTolerance) return true;
  for (const int joint : {2, 0, 4}) {
    for (const double shift : {3e-5, -3e-5}) {
      Vector6d beside = q;
      beside[joint] += shift;
      if (refine(X_RH, beside) < kPoseTolerance) {
        q = beside;
        return true;
      }
    }
  }
  return false;
}

}  // namespace opponens::robot
