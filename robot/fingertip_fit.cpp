// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/fingertip_fit.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <ceres/ceres.h>

namespace opponens::robot {

namespace {

constexpr double kCentimetres = 100.0;  ///< residuals are in cm, so that weights in rad compare with them
constexpr int kIterationsPerRound = 3;  ///< of the active set

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

/// 100 w TipError of all tips in one sample, x the fitted joints; Jacobian by RobotModel::point_jacobian. A second
/// block, where there is one, shifts the targets.
class TipCost : public ceres::CostFunction {
 public:
  TipCost(const RobotModel& hand, const FingertipFit& fit, Eigen::VectorXd q, Eigen::Index sample, double weight)
      : hand_(hand), fit_(fit), q_(std::move(q)), sample_(sample), weight_(kCentimetres * weight) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(fit.fitted.size()));
    if (fit.shifted) mutable_parameter_block_sizes()->push_back(3);
    set_num_residuals(3 * static_cast<int>(fit.targets.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto size = static_cast<Eigen::Index>(fit_.fitted.size());
    for (Eigen::Index i = 0; i < size; ++i) q_[fit_.fitted[static_cast<std::size_t>(i)]] = parameters[0][i];
    const Eigen::Vector3d shift =
        fit_.shifted ? Eigen::Vector3d(parameters[1][0], parameters[1][1], parameters[1][2]) : Eigen::Vector3d::Zero();
    hand_.link_poses(q_, X_RL_);
    const Eigen::Isometry3d X_PR = X_RL_[static_cast<std::size_t>(hand_.palm())].inverse();
    const bool wants_jacobian = jacobians && jacobians[0];
    for (std::size_t f = 0; f < fit_.targets.size(); ++f) {
      const TipTarget& target = fit_.targets[f];
      const Eigen::Vector3d p_R = X_RL_[static_cast<std::size_t>(target.finger.link)] * target.finger.p_L;
      const TipError error = tip_error(target, X_PR, X_PR * p_R - shift);
      Eigen::Map<Eigen::Vector3d> rows(residuals + 3 * f);
      rows = weight_ * error.residual();
      if (!wants_jacobian) continue;
      const Eigen::Matrix3Xd J_R = hand_.point_jacobian(X_RL_, target.finger.link, p_R);
      Eigen::Map<RowMajor> J(jacobians[0] + 3 * f * fit_.fitted.size(), 3, size);
      for (Eigen::Index i = 0; i < size; ++i) {
        const Eigen::Vector3d dp = X_PR.linear() * J_R.col(fit_.fitted[static_cast<std::size_t>(i)]);
        J.col(i) = weight_ * error.derivative(dp);
      }
    }
    if (fit_.shifted && jacobians && jacobians[1]) {
      for (int i = 0; i < num_residuals(); ++i) {
        for (int k = 0; k < 3; ++k) jacobians[1][3 * i + k] = i % 3 == k ? -weight_ : 0.0;
      }
    }
    return true;
  }

 private:
  TipError tip_error(const TipTarget& target, const Eigen::Isometry3d& X_PR, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d goal = target.path.col(sample_);
    if (!fit_.cylindrical || target.joints.empty()) return {p, goal};
    const FittedJoint& first = target.turning.at(target.joints.front());
    if (!first.revolute) return {p, goal};
    const Eigen::Isometry3d X_PC = X_PR * X_RL_[static_cast<std::size_t>(first.link)];
    return {p, goal, X_PC.translation(), X_PC.linear() * first.axis};
  }

  const RobotModel& hand_;
  const FingertipFit& fit_;
  mutable Eigen::VectorXd q_;  // scratch: one thread evaluates (Solver::Options::num_threads = 1)
  mutable std::vector<Eigen::Isometry3d> X_RL_;
  Eigen::Index sample_;
  double weight_;
};

/// Residuals sum over blocks of factor x block - constant: differences of neighbouring samples, or the deviation of one
/// from its rest posture.
class LinearCost : public ceres::CostFunction {
 public:
  LinearCost(std::vector<double> factors, Eigen::VectorXd constant)
      : factors_(std::move(factors)), constant_(std::move(constant)) {
    mutable_parameter_block_sizes()->assign(factors_.size(), static_cast<int>(constant_.size()));
    set_num_residuals(static_cast<int>(constant_.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index size = constant_.size();
    Eigen::Map<Eigen::VectorXd> rows(residuals, size);
    rows = -constant_;
    for (std::size_t block = 0; block < factors_.size(); ++block) {
      rows += factors_[block] * Eigen::Map<const Eigen::VectorXd>(parameters[block], size);
      if (!jacobians || !jacobians[block]) continue;
      Eigen::Map<RowMajor>(jacobians[block], size, size) = factors_[block] * Eigen::MatrixXd::Identity(size, size);
    }
    return true;
  }

 private:
  std::vector<double> factors_;
  Eigen::VectorXd constant_;
};

/// The time that each sample stands for, over the mean time between samples; ones for unrelated samples.
Eigen::VectorXd sample_shares(const Eigen::VectorXd& time, Eigen::Index samples) {
  Eigen::VectorXd shares = Eigen::VectorXd::Ones(samples);
  if (time.size() < 2) return shares;
  const double mean = (time(samples - 1) - time(0)) / static_cast<double>(samples - 1);
  for (Eigen::Index t = 0; t < samples; ++t) {
    const double before = t > 0 ? time(t) - time(t - 1) : time(1) - time(0);
    const double after = t + 1 < samples ? time(t + 1) - time(t) : before;
    shares[t] = 0.5 * (before + after) / mean;
  }
  return shares;
}

/// The fitted joints of all samples as one Ceres problem with bounds. Ceres clips steps to the bounds but solves for
/// them as if there were none, which creeps where many samples lie on a bound; so positions that the gradient pushes
/// out are held there in turn (active set), and the rest is solved.
class FingertipProblem {
 public:
  FingertipProblem(const RobotModel& hand, const FingertipFit& fit, const RetargetSettings& settings,
                   const Eigen::MatrixXd& q)
      : lower_(hand.lower()(fit.fitted)), upper_(hand.upper()(fit.fitted)), x_(q(fit.fitted, Eigen::all)) {
    const int size = static_cast<int>(fit.fitted.size());
    const Eigen::VectorXd shares = sample_shares(fit.time, x_.cols());
    for (Eigen::Index t = 0; t < x_.cols(); ++t) {
      double* block = x_.col(t).data();
      blocks_.push_back(block);
      problem_.AddParameterBlock(block, size);
      for (int i = 0; i < size; ++i) {
        problem_.SetParameterLowerBound(block, i, lower_[i]);
        problem_.SetParameterUpperBound(block, i, upper_[i]);
      }
      const double weight = std::sqrt(shares[t]);
      std::vector<double*> moved = {block};
      if (fit.shifted) moved.push_back(shift_.data());
      // The problem owns its cost functions.
      problem_.AddResidualBlock(new TipCost(hand, fit, q.col(t), t, weight), nullptr, moved);
      add_difference({block}, {weight * settings.rest}, weight * settings.rest * fit.rest.col(t));
    }
    if (fit.time.size() > 1) add_smoothness(fit.time, settings);
    options_.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options_.num_threads = 1;
    options_.logging_type = ceres::SILENT;
    options_.function_tolerance = fit.tolerance;
  }

  /// Whether the tolerance was met within the iterations of the settings.
  Result<bool> solve(int max_iterations) {
    Eigen::MatrixXi held = held_positions();
    ceres::Solver::Summary summary;
    double last = std::numeric_limits<double>::infinity();
    options_.max_num_iterations = kIterationsPerRound;
    while (max_iterations > 0) {
      hold(held);
      ceres::Solve(options_, &problem_, &summary);
      if (summary.termination_type == ceres::FAILURE) {
        return failure(FailureCode::not_converged, "fingertip fit: " + summary.message);
      }
      if (summary.iterations.empty()) return true;  // every position is held
      max_iterations -= std::max(1, static_cast<int>(summary.iterations.size()) - 1);
      options_.initial_trust_region_radius = summary.iterations.back().trust_region_radius;
      // Every round starts where the last ended, so the cost never rises; where it does not fall either, positions
      // only change between held and free at their bounds.
      const Eigen::MatrixXi next = held_positions();
      const bool settled = last - summary.final_cost <= options_.function_tolerance * summary.final_cost;
      if (settled || (next == held && summary.termination_type == ceres::CONVERGENCE)) return true;
      last = summary.final_cost;
      held = next;
    }
    return false;
  }

  const Eigen::Vector3d& shift() const { return shift_; }
  const Eigen::MatrixXd& positions() const { return x_; }

 private:
  void add_difference(const std::vector<double*>& blocks, std::vector<double> factors, Eigen::VectorXd constant) {
    problem_.AddResidualBlock(new LinearCost(std::move(factors), std::move(constant)), nullptr, blocks);
  }

  /// The time averages of |velocity q'|^2 and |acceleration q''|^2; see RetargetSettings.
  void add_smoothness(const Eigen::VectorXd& time, const RetargetSettings& settings) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(x_.rows());
    const auto samples = time.size();
    const double mean = (time(samples - 1) - time(0)) / static_cast<double>(samples - 1);
    for (std::size_t t = 1; t < blocks_.size(); ++t) {
      const double before = time(static_cast<Eigen::Index>(t)) - time(static_cast<Eigen::Index>(t) - 1);
      const double velocity = settings.velocity / std::sqrt(before * mean);
      if (velocity > 0.0) add_difference({blocks_[t - 1], blocks_[t]}, {-velocity, velocity}, zero);
      if (t + 1 == blocks_.size() || settings.acceleration == 0.0) continue;
      const double after = time(static_cast<Eigen::Index>(t) + 1) - time(static_cast<Eigen::Index>(t));
      const double acceleration = settings.acceleration / std::sqrt(0.5 * (before + after) * mean);
      add_difference({blocks_[t - 1], blocks_[t], blocks_[t + 1]},
                     {acceleration / before, -acceleration / before - acceleration / after, acceleration / after},
                     zero);
    }
  }

  /// 1 where a position is on a bound and the cost falls beyond it.
  Eigen::MatrixXi held_positions() {
    hold(Eigen::MatrixXi::Zero(x_.rows(), x_.cols()));
    ceres::Problem::EvaluateOptions evaluate;
    evaluate.parameter_blocks = blocks_;
    std::vector<double> values;
    problem_.Evaluate(evaluate, nullptr, nullptr, &values, nullptr);
    const Eigen::Map<const Eigen::MatrixXd> gradient(values.data(), x_.rows(), x_.cols());
    Eigen::MatrixXi held(x_.rows(), x_.cols());
    for (Eigen::Index t = 0; t < x_.cols(); ++t) {
      for (Eigen::Index i = 0; i < x_.rows(); ++i) {
        const bool out =
            (x_(i, t) <= lower_[i] && gradient(i, t) > 0.0) || (x_(i, t) >= upper_[i] && gradient(i, t) < 0.0);
        held(i, t) = out ? 1 : 0;
      }
    }
    return held;
  }

  void hold(const Eigen::MatrixXi& held) {
    for (Eigen::Index t = 0; t < x_.cols(); ++t) {
      double* block = blocks_[static_cast<std::size_t>(t)];
      std::vector<int> constant;
      for (int i = 0; i < x_.rows(); ++i) {
        if (held(i, t)) constant.push_back(i);
      }
      const bool whole = static_cast<Eigen::Index>(constant.size()) == x_.rows();
      const bool none = constant.empty() || whole;
      problem_.SetManifold(block, none ? nullptr : new ceres::SubsetManifold(static_cast<int>(x_.rows()), constant));
      whole ? problem_.SetParameterBlockConstant(block) : problem_.SetParameterBlockVariable(block);
    }
  }

  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::MatrixXd x_;  ///< [fitted x T]
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
  std::vector<double*> blocks_;
  ceres::Problem problem_;
  ceres::Solver::Options options_;
};

}  // namespace

Result<FitResult> fit_fingertips(const RobotModel& hand, const FingertipFit& fit, const RetargetSettings& settings,
                                 Eigen::MatrixXd& q) {
  FitResult result;
  if (fit.fitted.empty() || q.cols() == 0) return result;
  for (const FingertipFit& part : independent_parts(fit)) {
    FingertipProblem problem(hand, part, settings, q);
    const Result<bool> converged = problem.solve(settings.max_iterations);
    if (!converged) return tl::make_unexpected(converged.error());
    result.converged = result.converged && *converged;
    result.shift = problem.shift();
    q(part.fitted, Eigen::all) = problem.positions();
  }
  return result;
}

}  // namespace opponens::robot
