// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/likeness.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "core/require.hpp"

namespace opponens::analysis {
namespace {

using Cholesky = Eigen::LLT<Eigen::MatrixXd>;

const double kLogTwoPi = std::log(2.0 * std::numbers::pi);

void check(const SampleStatistics& a, const SampleStatistics& b, double ridge) {
  const Eigen::Index n = a.mean.size();
  require(n >= 1 && b.mean.size() == n && a.covariance.rows() == n && a.covariance.cols() == n &&
              b.covariance.rows() == n && b.covariance.cols() == n,
          "likeness: the two sets differ in dimension");
  require(std::isfinite(ridge) && ridge >= 0.0, "likeness: ridge must be a variance >= 0");
  require(a.mean.allFinite() && b.mean.allFinite() && a.covariance.allFinite() && b.covariance.allFinite(),
          "likeness: a mean or covariance is not finite");
}

Eigen::MatrixXd with_ridge(Eigen::MatrixXd covariance, double ridge) {
  covariance.diagonal().array() += ridge;
  return covariance;
}

bool usable(const Cholesky& factor) {
  return factor.info() == Eigen::Success && (factor.matrixLLT().diagonal().array() > 0.0).all();
}

double log_determinant(const Cholesky& factor) { return 2.0 * factor.matrixLLT().diagonal().array().log().sum(); }

double mahalanobis(const Cholesky& factor, const Eigen::VectorXd& d) { return factor.matrixL().solve(d).squaredNorm(); }

tl::unexpected<Failure> singular() {
  return failure(FailureCode::degenerate,
                 "the covariance is singular: drop constant and dependent channels or add a ridge");
}

}  // namespace

Result<double> log_likeness(const SampleStatistics& a, const SampleStatistics& b, double ridge, Normaliser normaliser) {
  check(a, b, ridge);
  const Cholesky factor(with_ridge(a.covariance + b.covariance, ridge));
  if (!usable(factor)) return singular();
  const auto n = static_cast<double>(a.mean.size());
  const double power = normaliser == Normaliser::printed ? 1.0 + 2.0 * n : n;
  return -0.5 * mahalanobis(factor, a.mean - b.mean) - 0.5 * log_determinant(factor) - 0.5 * power * kLogTwoPi;
}

Result<double> bhattacharyya_distance(const SampleStatistics& a, const SampleStatistics& b, double ridge) {
  check(a, b, ridge);
  const Cholesky factor_a(with_ridge(a.covariance, ridge));
  const Cholesky factor_b(with_ridge(b.covariance, ridge));
  const Cholesky middle(with_ridge(0.5 * (a.covariance + b.covariance), ridge));
  if (!usable(factor_a) || !usable(factor_b) || !usable(middle)) return singular();
  const double spread = log_determinant(middle) - 0.5 * (log_determinant(factor_a) + log_determinant(factor_b));
  return 0.125 * mahalanobis(middle, a.mean - b.mean) + 0.5 * spread;
}

Result<double> bhattacharyya_coefficient(const SampleStatistics& a, const SampleStatistics& b, double ridge) {
  return bhattacharyya_distance(a, b, ridge).map([](double distance) { return std::exp(-distance); });
}

}  // namespace opponens::analysis
