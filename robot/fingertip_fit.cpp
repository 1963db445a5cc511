// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/fingertip_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ceres/ceres.h>

#include "robot/tip_residuals.hpp"

namespace opponens::robot {

namespace {

constexpr int kIterationsPerRound = 3;  ///< of the active set

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// TipResiduals of one sample; x the fitted joints. A second block, where there is one, shifts the targets.
class TipCost : public ceres::CostFunction {
 public:
  TipCost(TipResiduals residuals, const FingertipFit& fit) : residuals_(std::move(residuals)) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(fit.fitted.size()));
    if (fit.shifted) mutable_parameter_block_sizes()->push_back(3);
    set_num_residuals(3 * static_cast<int>(fit.targets.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const bool shifted = parameter_block_sizes().size() > 1;
    residuals_.evaluate(parameters[0], shifted ? parameters[1] : nullptr, residuals,
                        jacobians ? jacobians[0] : nullptr);
    if (shifted && jacobians && jacobians[1]) residuals_.shift_jacobian(jacobians[1]);
    return true;
  }

 private:
  TipResiduals residuals_;
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

/// Whether a step was accepted; the first entry is the start.
bool moved(const ceres::Solver::Summary& summary) {
  return std::any_of(summary.iterations.begin() + 1, summary.iterations.end(),
                     [](const ceres::IterationSummary& iteration) { return iteration.step_is_successful; });
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
      problem_.AddResidualBlock(new TipCost(TipResiduals(hand, fit, q.col(t), t, weight), fit), nullptr, moved);
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
      // only change between held and free at their bounds. A round of rejected steps tells nothing: the next one has a
      // smaller trust region.
      const Eigen::MatrixXi next = held_positions();
      const bool converged = summary.termination_type == ceres::CONVERGENCE;
      const bool level = last - summary.final_cost <= options_.function_tolerance * summary.final_cost;
      if ((level && (converged || moved(summary))) || (next == held && converged)) return true;
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

/// All samples at once.
Result<FitResult> fit_together(const RobotModel& hand, const FingertipFit& fit, const RetargetSettings& settings,
                               Eigen::MatrixXd& q) {
  FitResult result;
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

}  // namespace

Result<FitResult> fit_fingertips(const RobotModel& hand, const FingertipFit& fit, const RetargetSettings& settings,
                                 Eigen::MatrixXd& q) {
  if (fit.fitted.empty() || q.cols() == 0) return FitResult();
  if (fit.time.size() > 0 || fit.shifted) return fit_together(hand, fit, settings, q);
  FitResult result;
  for (Eigen::Index t = 0; t < q.cols(); ++t) {
    Eigen::MatrixXd one = q.col(t);
    const auto fitted = fit_together(hand, sample_of(fit, t), settings, one);
    if (!fitted) return fitted;
    result.converged = result.converged && fitted->converged;
    q.col(t) = one;
  }
  return result;
}

}  // namespace opponens::robot
