// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/damped_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/QR>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/three_digits.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Mask = Eigen::Array<bool, Eigen::Dynamic, 1>;

constexpr double kMostDamping = 1e-2;  ///< to begin with, and the error's square where that is less
constexpr double kLeastDamping = 1e-24;
constexpr double kStationary = 1e-12;  ///< share of |e| that the free joints' columns see of it
constexpr double kStill = 1e-15;       ///< rad or m: a step no longer changes the position
constexpr double kLevel = 1e-6;        ///< relative fall below which an accepted step counts as none
constexpr int kLevelSteps = 4;         ///< so many in a row are a minimum

/// The tip's error and its derivative at q.
struct Linearised {
  Vector6 error;
  Jacobian jacobian;
  double cost() const { return error.squaredNorm(); }
  double residual() const { return std::max(error.head<3>().norm(), error.tail<3>().norm()); }
};

Linearised linearised(const KinematicChain& chain, const TipGoal& goal, const VectorXd& q) {
  Linearised at;
  const Isometry3d X_RT = tip_pose(chain, q, at.jacobian);
  at.error = pose_error(X_RT, goal.X_RT);
  if (goal.position_only) {
    at.error.head<3>().setZero();
    at.jacobian.topRows<3>().setZero();
  }
  return at;
}

/// Joints that are not held at a limit by the gradient.
Mask free_joints(const KinematicChain& chain, const VectorXd& q, const VectorXd& downhill) {
  Mask free = chain.moving();
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] <= chain.lower[i] && downhill[i] < 0.0) free[i] = false;
    if (q[i] >= chain.upper[i] && downhill[i] > 0.0) free[i] = false;
  }
  return free;
}

/// argmin |error - J dq|^2 + damping |dq|^2 over the free joints.
VectorXd damped_step(const Jacobian& jacobian, const Vector6& error, const Mask& free, double damping) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < free.size(); ++i) {
    if (free[i]) columns.push_back(i);
  }
  VectorXd step = VectorXd::Zero(free.size());
  const auto n = static_cast<Eigen::Index>(columns.size());
  if (n == 0) return step;
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(6 + n, n);
  stacked.topRows<6>() = jacobian(Eigen::all, columns);
  stacked.bottomRows(n).diagonal().setConstant(std::sqrt(damping));
  VectorXd right = VectorXd::Zero(6 + n);
  right.head<6>() = error;
  step(columns) = stacked.householderQr().solve(right);
  return step;
}

/// The same inside the limits: joints that would leave them stop there, one round of them after the other.
VectorXd bounded_step(const KinematicChain& chain, const VectorXd& q, const Linearised& at, Mask free, double damping) {
  VectorXd fixed = VectorXd::Zero(q.size());
  for (Eigen::Index round = 0; round <= q.size(); ++round) {
    const VectorXd step = fixed + damped_step(at.jacobian, at.error - at.jacobian * fixed, free, damping);
    bool inside = true;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double clipped = std::clamp(q[i] + step[i], chain.lower[i], chain.upper[i]);
      if (!free[i] || clipped == q[i] + step[i]) continue;
      fixed[i] = clipped - q[i];
      free[i] = false;
      inside = false;
    }
    if (inside) return step;
  }
  return fixed;
}

/// No chain reaches farther than its lengths together, from the first joint's origin.
double longest_reach(const KinematicChain& chain) {
  double reach = chain.X_JT.translation().norm();
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const KinematicChain::Joint& joint = chain.joints[i];
    if (i > 0) reach += joint.X_PJ.translation().norm();
    if (joint.revolute) continue;
    const double low = joint.multiplier * chain.lower[joint.index] + joint.offset;
    const double high = joint.multiplier * chain.upper[joint.index] + joint.offset;
    reach += std::max(std::abs(low), std::abs(high));
  }
  return reach;
}

/// Every joint nearer than apart, whole turns aside.
bool alike(const VectorXd& a, const VectorXd& b, const Mask& turns, double apart) {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double difference = turns[i] ? std::remainder(a[i] - b[i], 2.0 * std::numbers::pi) : a[i] - b[i];
    if (std::abs(difference) > apart) return false;
  }
  return true;
}

}  // namespace

Descent descend(const KinematicChain& chain, const TipGoal& goal, const Eigen::Ref<const VectorXd>& q,
                int max_iterations, double tolerance) {
  Descent descent{q.cwiseMax(chain.lower).cwiseMin(chain.upper)};
  Linearised at = linearised(chain, goal, descent.q);
  double damping = std::clamp(at.cost(), kLeastDamping, kMostDamping);
  double growth = 2.0;
  int level = 0;
  while (descent.iterations < max_iterations && at.residual() >= tolerance) {
    const VectorXd downhill = at.jacobian.transpose() * at.error;
    const Mask free = free_joints(chain, descent.q, downhill);
    const double slope = free.select(downhill.array(), 0.0).matrix().norm();
    descent.stationary = slope <= kStationary * std::sqrt(at.cost()) * at.jacobian.norm() || level >= kLevelSteps;
    if (descent.stationary) break;
    ++descent.iterations;
    const VectorXd step = bounded_step(chain, descent.q, at, free, damping);
    const VectorXd next = (descent.q + step).cwiseMax(chain.lower).cwiseMin(chain.upper);
    const Linearised there = linearised(chain, goal, next);
    const double predicted = at.cost() - (at.error - at.jacobian * step).squaredNorm();
    const double actual = at.cost() - there.cost();
    if (actual > 0.0 && predicted > 0.0) {
      level = actual < kLevel * at.cost() ? level + 1 : 0;
      const double gain = 2.0 * actual / predicted - 1.0;
      damping = std::max(kLeastDamping, damping * std::max(1.0 / 10.0, 1.0 - gain * gain * gain));
      growth = 2.0;
      descent.q = next;
      at = there;
    } else {
      descent.stationary = step.cwiseAbs().maxCoeff() < kStill;
      if (descent.stationary) break;
      damping *= growth;
      growth *= 2.0;
    }
  }
  descent.residual = at.residual();
  return descent;
}

void validate(const DampedLeastSquaresSettings& settings) {
  require(settings.restarts > 0, "restarts must be positive, is " + std::to_string(settings.restarts));
  require(settings.max_iterations > 0,
          "max_iterations must be positive, is " + std::to_string(settings.max_iterations));
  require(settings.max_solutions > 0, "max_solutions must be positive, is " + std::to_string(settings.max_solutions));
  require(settings.tolerance >= 1e-13, "tolerance must be at least 1e-13, is " + three_digits(settings.tolerance));
  require(settings.apart > 0.0, "apart must be positive, is " + three_digits(settings.apart));
}

Result<std::vector<VectorXd>> solve_damped(const KinematicChain& chain, const Isometry3d& X_RT,
                                           const std::vector<VectorXd>& near,
                                           const DampedLeastSquaresSettings& settings) {
  validate(settings);
  require(X_RT.matrix().allFinite(), "the tip's pose is not finite");
  for (const VectorXd& q : near) require(q.size() == chain.lower.size() && q.allFinite(), "near: not of this chain");
  const double beyond =
      (X_RT.translation() - chain.joints.front().X_PJ.translation()).norm() - longest_reach(chain) - settings.tolerance;
  if (beyond > 0.0) {
    return failure(FailureCode::out_of_reach,
                   "the tip's pose is " + three_digits(beyond) + " m beyond all lengths together");
  }
  const Mask moving = chain.moving();
  const Mask turns = chain.turns();
  Rng rng = stream(settings.seed, "inverse kinematics");
  const int descents = near.empty() ? settings.restarts : static_cast<int>(near.size());
  std::vector<VectorXd> solutions;
  double least = std::numeric_limits<double>::infinity();
  bool all_minima = true;
  for (int i = 0; i < descents && static_cast<int>(solutions.size()) < settings.max_solutions; ++i) {
    VectorXd start = near.empty() ? VectorXd(0.5 * (chain.lower + chain.upper)) : near[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < start.size(); ++j) {
      if (near.empty() && i > 0) start[j] = rng.uniform(chain.lower[j], chain.upper[j]);
      if (!moving[j]) start[j] = chain.rest[j];
    }
    const Descent descent =
        descend(chain, {X_RT, settings.position_only}, start, settings.max_iterations, settings.tolerance);
    least = std::min(least, descent.residual);
    all_minima = all_minima && descent.stationary;
    if (!(descent.residual < settings.tolerance)) continue;
    const bool known = std::any_of(solutions.begin(), solutions.end(), [&](const VectorXd& other) {
      return alike(other, descent.q, turns, settings.apart);
    });
    if (!known) solutions.push_back(descent.q);
  }
  if (!solutions.empty()) return solutions;
  return failure(all_minima ? FailureCode::out_of_reach : FailureCode::not_converged,
                 "no position reaches the tip's pose: in " + std::to_string(descents) + " descents it came within " +
                     three_digits(least) + " (m and rad)");
}

}  // namespace opponens::robot
