// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/fingertip_fit.hpp"

#include <utility>

#include <ceres/ceres.h>

namespace opponens::robot {

namespace {

constexpr double kCentimetres = 100.0;  ///< residuals are in cm, so that weights in rad compare with them

/// Residuals 100 (p(q) - p*) of one tip in one sample; the Jacobian is RobotModel::point_jacobian's.
class TipCost : public ceres::CostFunction {
 public:
  TipCost(const RobotModel& hand, const TipTarget& target, const Eigen::MatrixXd& q, Eigen::Index sample)
      : hand_(hand), target_(target), q_(q.col(sample)), sample_(sample) {
    mutable_parameter_block_sizes()->assign(target.joints.size(), 1);
    set_num_residuals(3);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    for (std::size_t i = 0; i < target_.joints.size(); ++i) q_[target_.joints[i]] = *parameters[i];
    hand_.link_poses(q_, X_RL_);
    const Eigen::Isometry3d& X_RP = X_RL_[static_cast<std::size_t>(hand_.palm())];
    const Eigen::Vector3d p_R = X_RL_[static_cast<std::size_t>(target_.finger.link)] * target_.finger.p_L;
    Eigen::Map<Eigen::Vector3d> error(residuals);
    error = kCentimetres * (X_RP.linear().transpose() * (p_R - X_RP.translation()) - target_.path.col(sample_));
    if (!jacobians) return true;
    const Eigen::Matrix3Xd J_R = hand_.point_jacobian(X_RL_, target_.finger.link, p_R);
    for (std::size_t i = 0; i < target_.joints.size(); ++i) {
      if (!jacobians[i]) continue;
      Eigen::Map<Eigen::Vector3d>(jacobians[i]) =
          kCentimetres * (X_RP.linear().transpose() * J_R.col(target_.joints[i]));
    }
    return true;
  }

 private:
  const RobotModel& hand_;
  const TipTarget& target_;
  mutable Eigen::VectorXd q_;  // scratch: one thread evaluates (Solver::Options::num_threads = 1)
  mutable std::vector<Eigen::Isometry3d> X_RL_;
  Eigen::Index sample_;
};

/// Residual weight (b - a), or weight (a - rest) with one joint position.
class DifferenceCost : public ceres::CostFunction {
 public:
  explicit DifferenceCost(double weight) : weight_(weight) {
    mutable_parameter_block_sizes()->assign(2, 1);
    set_num_residuals(1);
  }
  DifferenceCost(double weight, double rest) : weight_(-weight), rest_(rest) {
    mutable_parameter_block_sizes()->assign(1, 1);
    set_num_residuals(1);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const bool pair = parameter_block_sizes().size() == 2;
    residuals[0] = weight_ * ((pair ? *parameters[1] : rest_) - *parameters[0]);
    if (jacobians && jacobians[0]) jacobians[0][0] = -weight_;
    if (jacobians && pair && jacobians[1]) jacobians[1][0] = weight_;
    return true;
  }

 private:
  double weight_;
  double rest_ = 0.0;
};

ceres::Solver::Options solver_options(const RetargetSettings& settings) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

std::optional<Failure> fit_fingertips(const RobotModel& hand, const std::vector<TipTarget>& targets,
                                      const std::vector<int>& fitted, const RetargetSettings& settings,
                                      Eigen::MatrixXd& q) {
  if (fitted.empty() || q.cols() == 0) return std::nullopt;
  ceres::Problem problem;
  Eigen::MatrixXd start = q;  // cost functions copy the joints that are not fitted from here
  for (const int joint : fitted) {
    for (Eigen::Index t = 0; t < q.cols(); ++t) {
      double* position = &q(joint, t);
      problem.AddParameterBlock(position, 1);
      problem.SetParameterLowerBound(position, 0, hand.lower()[joint]);
      problem.SetParameterUpperBound(position, 0, hand.upper()[joint]);
      if (settings.rest > 0.0) {
        const double middle = 0.5 * (hand.lower()[joint] + hand.upper()[joint]);
        problem.AddResidualBlock(new DifferenceCost(settings.rest, middle), nullptr, position);
      }
      if (settings.smoothness > 0.0 && t > 0) {
        problem.AddResidualBlock(new DifferenceCost(settings.smoothness), nullptr, &q(joint, t - 1), position);
      }
    }
  }
  for (const TipTarget& target : targets) {
    if (target.joints.empty()) continue;
    for (Eigen::Index t = 0; t < q.cols(); ++t) {
      std::vector<double*> positions;
      for (const int joint : target.joints) positions.push_back(&q(joint, t));
      problem.AddResidualBlock(new TipCost(hand, target, start, t), nullptr, positions);  // the problem owns it
    }
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(settings), &problem, &summary);
  if (summary.termination_type == ceres::CONVERGENCE) return std::nullopt;
  return Failure{FailureCode::not_converged, "fingertip fit: " + summary.message};
}

}  // namespace opponens::robot
