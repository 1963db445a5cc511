// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/fingertip_fit.hpp"

#include <cmath>
#include <utility>

#include <ceres/ceres.h>

namespace opponens::robot {

namespace {

constexpr double kCentimetres = 100.0;  ///< residuals are in cm, so that weights in rad compare with them
constexpr int kRounds = 20;             ///< of the active set; two or three are usual

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

/// 100 TipError of all tips in one sample, x the fitted joints; Jacobian by RobotModel::point_jacobian.
class TipCost : public ceres::CostFunction {
 public:
  TipCost(const RobotModel& hand, const std::vector<TipTarget>& targets, const std::vector<int>& fitted,
          Eigen::VectorXd q, Eigen::Index sample)
      : hand_(hand), targets_(targets), fitted_(fitted), q_(std::move(q)), sample_(sample) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(fitted.size()));
    set_num_residuals(3 * static_cast<int>(targets.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto size = static_cast<Eigen::Index>(fitted_.size());
    for (Eigen::Index i = 0; i < size; ++i) q_[fitted_[static_cast<std::size_t>(i)]] = parameters[0][i];
    hand_.link_poses(q_, X_RL_);
    const Eigen::Isometry3d X_PR = X_RL_[static_cast<std::size_t>(hand_.palm())].inverse();
    const bool wants_jacobian = jacobians && jacobians[0];
    for (std::size_t f = 0; f < targets_.size(); ++f) {
      const TipTarget& target = targets_[f];
      const Eigen::Vector3d p_R = X_RL_[static_cast<std::size_t>(target.finger.link)] * target.finger.p_L;
      const TipError error = tip_error(target, X_PR, X_PR * p_R);
      Eigen::Map<Eigen::Vector3d> rows(residuals + 3 * f);
      rows = kCentimetres * error.residual();
      if (!wants_jacobian) continue;
      const Eigen::Matrix3Xd J_R = hand_.point_jacobian(X_RL_, target.finger.link, p_R);
      Eigen::Map<RowMajor> J(jacobians[0] + 3 * f * fitted_.size(), 3, size);
      for (Eigen::Index i = 0; i < size; ++i) {
        const Eigen::Vector3d dp = X_PR.linear() * J_R.col(fitted_[static_cast<std::size_t>(i)]);
        J.col(i) = kCentimetres * error.derivative(dp);
      }
    }
    return true;
  }

 private:
  TipError tip_error(const TipTarget& target, const Eigen::Isometry3d& X_PR, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d goal = target.path.col(sample_);
    if (target.joints.empty()) return {p, goal};
    const FittedJoint& first = target.turning.at(target.joints.front());
    if (!first.revolute) return {p, goal};
    const Eigen::Isometry3d X_PC = X_PR * X_RL_[static_cast<std::size_t>(first.link)];
    return {p, goal, X_PC.translation(), X_PC.linear() * first.axis};
  }

  const RobotModel& hand_;
  const std::vector<TipTarget>& targets_;
  const std::vector<int>& fitted_;
  mutable Eigen::VectorXd q_;  // scratch: one thread evaluates (Solver::Options::num_threads = 1)
  mutable std::vector<Eigen::Isometry3d> X_RL_;
  Eigen::Index sample_;
};

/// Residuals weight (b - a) of neighbouring samples, or weight (a - rest) of one.
class DifferenceCost : public ceres::CostFunction {
 public:
  DifferenceCost(double weight, int size) : weight_(weight) {
    mutable_parameter_block_sizes()->assign(2, size);
    set_num_residuals(size);
  }
  DifferenceCost(double weight, Eigen::VectorXd rest) : weight_(-weight), rest_(std::move(rest)) {
    mutable_parameter_block_sizes()->assign(1, static_cast<int>(rest_.size()));
    set_num_residuals(static_cast<int>(rest_.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const int size = num_residuals();
    const std::size_t blocks = parameter_block_sizes().size();
    const double* end = blocks == 2 ? parameters[1] : rest_.data();
    for (int i = 0; i < size; ++i) residuals[i] = weight_ * (end[i] - parameters[0][i]);
    for (std::size_t block = 0; jacobians && block < blocks; ++block) {
      if (!jacobians[block]) continue;
      Eigen::Map<RowMajor> J(jacobians[block], size, size);
      J = (block == 0 ? -weight_ : weight_) * Eigen::MatrixXd::Identity(size, size);
    }
    return true;
  }

 private:
  double weight_;
  Eigen::VectorXd rest_;
};

/// The fitted joints of all samples as one Ceres problem with bounds. Ceres clips steps to the bounds but solves for
/// them as if there were none, which creeps where many samples lie on a bound; so positions that the gradient pushes
/// out are held there in turn (active set), and the rest is solved.
class FingertipProblem {
 public:
  FingertipProblem(const RobotModel& hand, const std::vector<TipTarget>& targets, const std::vector<int>& fitted,
                   const RetargetSettings& settings, const Eigen::MatrixXd& q)
      : lower_(hand.lower()(fitted)), upper_(hand.upper()(fitted)), x_(q(fitted, Eigen::all)) {
    const int size = static_cast<int>(fitted.size());
    for (Eigen::Index t = 0; t < x_.cols(); ++t) {
      problem_.AddParameterBlock(x_.col(t).data(), size);
      for (int i = 0; i < size; ++i) {
        problem_.SetParameterLowerBound(x_.col(t).data(), i, lower_[i]);
        problem_.SetParameterUpperBound(x_.col(t).data(), i, upper_[i]);
      }
      blocks_.push_back(x_.col(t).data());
      // The problem owns its cost functions.
      problem_.AddResidualBlock(new TipCost(hand, targets, fitted, q.col(t), t), nullptr, blocks_.back());
      problem_.AddResidualBlock(new DifferenceCost(settings.rest, 0.5 * (lower_ + upper_)), nullptr, blocks_.back());
      if (t == 0) continue;
      problem_.AddResidualBlock(new DifferenceCost(settings.smoothness, size), nullptr, x_.col(t - 1).data(),
                                blocks_.back());
    }
    options_.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options_.num_threads = 1;
    options_.logging_type = ceres::SILENT;
    options_.function_tolerance = 1e-9;
  }

  /// Whether the tolerance was met within the iterations of the settings; otherwise the solver's reason.
  std::optional<std::string> solve(int max_iterations) {
    Eigen::MatrixXi held = held_positions();
    ceres::Solver::Summary summary;
    for (int round = 0; round < kRounds && max_iterations > 0; ++round) {
      hold(held);
      options_.max_num_iterations = max_iterations;
      ceres::Solve(options_, &problem_, &summary);
      if (summary.termination_type == ceres::FAILURE) return summary.message;
      max_iterations -= std::max(1, static_cast<int>(summary.iterations.size()) - 1);
      const Eigen::MatrixXi next = held_positions();
      if (next == held && summary.termination_type == ceres::CONVERGENCE) return std::nullopt;
      held = next;
    }
    return "the iteration limit was reached: " + summary.message;
  }

  const Eigen::MatrixXd& positions() const { return x_; }

 private:
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
  std::vector<double*> blocks_;
  ceres::Problem problem_;
  ceres::Solver::Options options_;
};

}  // namespace

std::optional<Failure> fit_fingertips(const RobotModel& hand, const std::vector<TipTarget>& targets,
                                      const std::vector<int>& fitted, const RetargetSettings& settings,
                                      Eigen::MatrixXd& q) {
  if (fitted.empty() || q.cols() == 0) return std::nullopt;
  seed_positions(hand, targets, fitted, q);
  FingertipProblem problem(hand, targets, fitted, settings, q);
  if (const auto reason = problem.solve(settings.max_iterations)) {
    return Failure{FailureCode::not_converged, "fingertip fit: " + *reason};
  }
  q(fitted, Eigen::all) = problem.positions();
  return std::nullopt;
}

}  // namespace opponens::robot
