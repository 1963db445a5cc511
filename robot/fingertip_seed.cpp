// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/fingertip_fit.hpp"

namespace opponens::robot {

namespace {

constexpr int kSweeps = 30;

/// Where the circle on which joint turns its tips is nearest to their targets: the position in [low, high] with the
/// largest A cos(x) + B sin(x), x the turn from here, A and B summed over the tips. Unchanged where the tips or targets
/// lie on the axis.
double best_turn(const RobotModel& hand, const std::vector<TipTarget>& targets, int joint, Eigen::Index sample,
                 const Eigen::VectorXd& q, const std::vector<Eigen::Isometry3d>& X_RL) {
  const Eigen::Isometry3d X_PR = X_RL[static_cast<std::size_t>(hand.palm())].inverse();
  double A = 0.0;
  double B = 0.0;
  for (const TipTarget& target : targets) {
    if (std::find(target.joints.begin(), target.joints.end(), joint) == target.joints.end()) continue;
    const FittedJoint& turning = target.turning.at(joint);
    if (!turning.revolute) return q[joint];
    const Eigen::Isometry3d X_PC = X_PR * X_RL[static_cast<std::size_t>(turning.link)];
    const Eigen::Vector3d axis = X_PC.linear() * turning.axis;
    const Eigen::Vector3d tip =
        X_PR * X_RL[static_cast<std::size_t>(target.finger.link)] * target.finger.p_L - X_PC.translation();
    const Eigen::Vector3d goal = target.path.col(sample) - X_PC.translation();
    A += tip.dot(goal) - axis.dot(tip) * axis.dot(goal);
    B += axis.dot(tip.cross(goal));
  }
  if (std::hypot(A, B) < 1e-10) return q[joint];
  const double low = hand.lower()[joint];
  const double high = hand.upper()[joint];
  const double middle = 0.5 * (low + high);
  const double best = middle + std::remainder(q[joint] + std::atan2(B, A) - middle, 2.0 * std::numbers::pi);
  if (best >= low && best <= high) return best;
  const auto value = [&](double at) { return A * std::cos(at - q[joint]) + B * std::sin(at - q[joint]); };
  return value(low) > value(high) ? low : high;
}

}  // namespace

void seed_positions(const RobotModel& hand, const FingertipFit& fit, Eigen::MatrixXd& q) {
  std::vector<Eigen::Isometry3d> X_RL;
  for (Eigen::Index t = 0; t < q.cols(); ++t) {
    if (t > 0 && fit.time.size() > 0) {
      for (const int joint : fit.fitted) q(joint, t) = q(joint, t - 1);
    }
    Eigen::VectorXd position = q.col(t);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double change = 0.0;
      for (const int joint : fit.fitted) {
        hand.link_poses(position, X_RL);
        const double best = best_turn(hand, fit.targets, joint, t, position, X_RL);
        change = std::max(change, std::abs(best - position[joint]));
        position[joint] = best;
      }
      if (change < 1e-4) break;
    }
    q.col(t) = position;
  }
}

}  // namespace opponens::robot
