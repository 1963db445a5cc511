// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/pca.hpp"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "core/require.hpp"

namespace opponens::analysis {

SynergyBasis principal_axes(const SampleStatistics& statistics) {
  const Eigen::Index n = statistics.mean.size();
  require(n >= 1 && statistics.covariance.rows() == n && statistics.covariance.cols() == n,
          "principal_axes: mean and covariance differ in size");
  require(statistics.covariance.allFinite(), "principal_axes: covariance is not finite");
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(statistics.covariance);
  require(solver.info() == Eigen::Success, "principal_axes: the eigen-decomposition did not converge");
  SynergyBasis basis;
  basis.mean = statistics.mean;
  basis.axes = solver.eigenvectors().rowwise().reverse();
  basis.variance = solver.eigenvalues().reverse().cwiseMax(0.0);
  basis.count = statistics.count;
  for (auto axis : basis.axes.colwise()) {
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0.0) axis = -axis;
  }
  return basis;
}

Eigen::VectorXd cumulative_variance(const Eigen::VectorXd& variance) {
  require(variance.size() >= 1 && (variance.array() >= 0.0).all(), "cumulative_variance: a variance is negative");
  const double total = variance.sum();
  if (total == 0.0) return Eigen::VectorXd::Ones(variance.size());
  Eigen::VectorXd result(variance.size());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < variance.size(); ++i) {
    sum += variance[i];
    result[i] = std::min(1.0, sum / total);  // rounding may exceed it
  }
  result[variance.size() - 1] = 1.0;
  return result;
}

}  // namespace opponens::analysis
