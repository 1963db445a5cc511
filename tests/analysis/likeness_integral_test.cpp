// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Eq. (1) against a Monte Carlo integral. A sample x of the first distribution is kept with probability
// p_B(x) / max p_B; of N samples Binomial(N, L / max p_B) are kept, exactly. Likewise the Bhattacharyya coefficient,
// the integral of sqrt(p_A p_B): x of A is kept with probability sqrt(p_B(x) / p_A(x)) / bound.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "analysis/likeness.hpp"
#include "tests/analysis/binomial_bound.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

constexpr int kDraws = 400000;

/// Log density of a normal distribution, by a factorisation of its own.
class Normal {
 public:
  explicit Normal(const SampleStatistics& s) : mean_(s.mean), factor_(s.covariance) {
    const Eigen::MatrixXd lower = factor_.matrixL();
    log_peak_ = -0.5 * static_cast<double>(mean_.size()) * std::log(2.0 * std::numbers::pi) -
                lower.diagonal().array().log().sum();
  }
  Eigen::VectorXd draw(Rng& rng) const {
    return mean_ + factor_.matrixL() * Eigen::VectorXd(test::normal_matrix(mean_.size(), 1, rng));
  }
  double log_density(const Eigen::VectorXd& x) const {
    return log_peak_ - 0.5 * factor_.matrixL().solve(x - mean_).squaredNorm();
  }
  double log_peak() const { return log_peak_; }

 private:
  Eigen::VectorXd mean_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double log_peak_;
};

/// Covariances with a common scale, so that the overlap is not too small to be counted.
SampleStatistics random_gaussian(int n, Rng& rng) {
  const Eigen::MatrixXd a = test::normal_matrix(n, n, rng) / std::sqrt(n);
  return {1.0, 0.3 * test::normal_matrix(n, 1, rng), Eigen::MatrixXd::Identity(n, n) + 0.5 * a * a.transpose()};
}

class LikenessIntegral : public testing::TestWithParam<int> {
 protected:
  const int n = GetParam();
  Rng rng = test::numbered_stream(21, "likeness integral/", n);
  const SampleStatistics a = random_gaussian(n, rng);
  const SampleStatistics b = random_gaussian(n, rng);
  const Normal first{a};
  const Normal second{b};
};

TEST_P(LikenessIntegral, IsTheOverlapOfTheDensities) {
  int kept = 0;
  for (int i = 0; i < kDraws; ++i) {
    kept += rng.uniform() < std::exp(second.log_density(first.draw(rng)) - second.log_peak()) ? 1 : 0;
  }
  const auto share = [&](double log_value) { return std::exp(log_value - second.log_peak()); };
  EXPECT_TRUE(test::is_binomial(kept, kDraws, share(log_likeness(a, b, 0.0).value())));
  // Known-wrong rules: the printed normaliser, and a factor 1/2 forgotten in the covariance.
  EXPECT_FALSE(test::is_binomial(kept, kDraws, share(log_likeness(a, b, 0.0, Normaliser::printed).value())));
  SampleStatistics half = b;
  half.covariance *= 0.5;
  EXPECT_FALSE(test::is_binomial(kept, kDraws, std::min(1.0, share(log_likeness(a, half, 0.0).value()))));
}

TEST_P(LikenessIntegral, BhattacharyyaCoefficientIsTheIntegralOfTheGeometricMean) {
  // Drawn from the wider of a and b with p_mid the normal of the mean covariance x 2: a proposal that bounds the ratio.
  SampleStatistics wide{1.0, 0.5 * (a.mean + b.mean), 2.0 * (a.covariance + b.covariance)};
  const Normal proposal(wide);
  // log sqrt(p_A p_B) - log p_wide is a quadratic; its maximum is where its gradient vanishes.
  const Eigen::MatrixXd pa = a.covariance.inverse();
  const Eigen::MatrixXd pb = b.covariance.inverse();
  const Eigen::MatrixXd pw = wide.covariance.inverse();
  const Eigen::MatrixXd curvature = 0.5 * (pa + pb) - pw;
  const Eigen::VectorXd peak = curvature.llt().solve(0.5 * (pa * a.mean + pb * b.mean) - pw * wide.mean);
  const auto log_ratio = [&](const Eigen::VectorXd& x) {
    return 0.5 * (first.log_density(x) + second.log_density(x)) - proposal.log_density(x);
  };
  const double bound = log_ratio(peak);
  int kept = 0;
  for (int i = 0; i < kDraws; ++i) kept += rng.uniform() < std::exp(log_ratio(proposal.draw(rng)) - bound) ? 1 : 0;
  const double coefficient = bhattacharyya_coefficient(a, b, 0.0).value();
  EXPECT_TRUE(test::is_binomial(kept, kDraws, coefficient * std::exp(-bound)));
  // Known wrong: the likeness of the two scaled by its value for equal distributions, which is not the same measure.
  const double relative = std::exp(log_likeness(a, b, 0.0).value() - log_likeness(a, a, 0.0).value());
  EXPECT_FALSE(test::is_binomial(kept, kDraws, std::min(1.0, relative * std::exp(-bound))));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, LikenessIntegral, testing::Values(1, 2, 4, 8));

}  // namespace
}  // namespace opponens::analysis
