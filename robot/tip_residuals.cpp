// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/tip_residuals.hpp"

#include <cmath>
#include <utility>

namespace opponens::robot {

namespace {

constexpr double kCentimetres = 100.0;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Residuals whose squares sum to |p - p*|^2, for tip p and target p*, and their derivative along a motion of p. Where
/// the target is far out of reach, Gauss-Newton on p - p* itself overshoots: the circle that the tip runs on bends
/// towards the target. In cylinder coordinates about the axis of the first fitted joint,
///   |p - p*|^2 = (r - r*)^2 + (z - z*)^2 + 4 r r* sin^2((phi - phi*) / 2),
/// only the last term changes with that joint, and it can vanish.
class TipError {
 public:
  TipError(const Eigen::Vector3d& p, const Eigen::Vector3d& target) : plain_(p - target) {}
  TipError(const Eigen::Vector3d& p, const Eigen::Vector3d& target, const Eigen::Vector3d& origin,
           const Eigen::Vector3d& axis)
      : axis_(axis), plain_(p - target) {
    const Eigen::Vector3d flat = p - origin - axis.dot(p - origin) * axis;
    const Eigen::Vector3d flat_target = target - origin - axis.dot(target - origin) * axis;
    const double r = flat.norm();
    const double r_target = flat_target.norm();
    cylindrical_ = r > kOnAxis && r_target > kOnAxis;
    if (!cylindrical_) return;
    along_ = flat / r;
    const double half = 0.5 * std::atan2(axis.dot(flat_target.cross(flat)), flat_target.dot(flat));  // (phi - phi*) / 2
    const double root = std::sqrt(r_target / r);
    residual_ = {r - r_target, axis.dot(p - target), 2.0 * root * r * std::sin(half)};
    slope_ = root * (std::sin(half) * along_ + std::cos(half) * axis.cross(along_));
  }

  Eigen::Vector3d residual() const { return cylindrical_ ? residual_ : plain_; }
  Eigen::Vector3d derivative(const Eigen::Vector3d& dp) const {
    return cylindrical_ ? Eigen::Vector3d(along_.dot(dp), axis_.dot(dp), slope_.dot(dp)) : dp;
  }

 private:
  static constexpr double kOnAxis = 1e-6;  ///< m: there the plain difference, of the same square, is used
  Eigen::Vector3d axis_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d plain_;
  bool cylindrical_ = false;
  Eigen::Vector3d along_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d residual_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d slope_ = Eigen::Vector3d::Zero();
};

TipError tip_error(const FingertipFit& fit, const TipTarget& target, const Eigen::Vector3d& goal,
                   const std::vector<Eigen::Isometry3d>& X_RL, const Eigen::Isometry3d& X_PR,
                   const Eigen::Vector3d& p) {
  if (!fit.cylindrical || target.joints.empty()) return {p, goal};
  const FittedJoint& first = target.turning.at(target.joints.front());
  if (!first.revolute) return {p, goal};
  const Eigen::Isometry3d X_PC = X_PR * X_RL[static_cast<std::size_t>(first.link)];
  return {p, goal, X_PC.translation(), X_PC.linear() * first.axis};
}

}  // namespace

TipResiduals::TipResiduals(const RobotModel& hand, const FingertipFit& fit, Eigen::VectorXd q, Eigen::Index sample,
                           double weight)
    : hand_(hand), fit_(fit), q_(std::move(q)), sample_(sample), weight_(kCentimetres * weight) {}

void TipResiduals::evaluate(const double* x, const double* shift, double* residuals, double* jacobian) const {
  const auto size = static_cast<Eigen::Index>(fit_.fitted.size());
  for (Eigen::Index i = 0; i < size; ++i) q_[fit_.fitted[static_cast<std::size_t>(i)]] = x[i];
  const Eigen::Vector3d moved = shift ? Eigen::Vector3d(shift[0], shift[1], shift[2]) : Eigen::Vector3d::Zero();
  hand_.link_poses(q_, X_RL_);
  const Eigen::Isometry3d X_PR = X_RL_[static_cast<std::size_t>(hand_.palm())].inverse();
  for (std::size_t f = 0; f < fit_.targets.size(); ++f) {
    const TipTarget& target = fit_.targets[f];
    const Eigen::Vector3d p_R = X_RL_[static_cast<std::size_t>(target.finger.link)] * target.finger.p_L;
    const TipError error = tip_error(fit_, target, target.path.col(sample_), X_RL_, X_PR, X_PR * p_R - moved);
    Eigen::Map<Eigen::Vector3d> rows(residuals + 3 * f);
    rows = weight_ * error.residual();
    if (!jacobian) continue;
    const Eigen::Matrix3Xd J_R = hand_.point_jacobian(X_RL_, target.finger.link, p_R);
    Eigen::Map<RowMajor> J(jacobian + 3 * f * fit_.fitted.size(), 3, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Vector3d dp = X_PR.linear() * J_R.col(fit_.fitted[static_cast<std::size_t>(i)]);
      J.col(i) = weight_ * error.derivative(dp);
    }
  }
}

void TipResiduals::shift_jacobian(double* jacobian) const {
  Eigen::Map<RowMajor> J(jacobian, 3 * static_cast<Eigen::Index>(fit_.targets.size()), 3);
  for (Eigen::Index i = 0; i < J.rows(); ++i) J.row(i) = -weight_ * Eigen::RowVector3d::Unit(i % 3);
}

}  // namespace opponens::robot
