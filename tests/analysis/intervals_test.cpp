// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/intervals.hpp"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

TEST(BootstrapQuantile, HandComputed) {
  const std::vector<double> sorted{1, 2, 3, 4};
  EXPECT_DOUBLE_EQ(bootstrap_quantile(sorted, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(bootstrap_quantile(sorted, 0.2), 1.0);
  EXPECT_DOUBLE_EQ(bootstrap_quantile(sorted, 0.7), 3.5);
  EXPECT_DOUBLE_EQ(bootstrap_quantile(sorted, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(bootstrap_quantile(sorted, 1.0), 4.0);
}

TEST(BasicLogitInterval, ReflectsAndStaysInside) {
  std::vector<double> replicates;
  for (int i = 1; i <= 199; ++i) replicates.push_back(0.90 + 0.0004 * i);
  const auto logit = [](double p) { return std::log(p / (1 - p)); };
  const Interval found = basic_logit_interval(0.93, replicates, 0.95);
  // The 5th and 195th of 199: (199 + 1) 0.025 = 5.
  EXPECT_NEAR(logit(found.low), 2 * logit(0.93) - logit(replicates[194]), 1e-12);
  EXPECT_NEAR(logit(found.high), 2 * logit(0.93) - logit(replicates[4]), 1e-12);
  const Interval extreme = basic_logit_interval(0.9999, {0.5, 0.6, 1.0, 1.0}, 0.95);
  EXPECT_GE(extreme.low, 0.0);
  EXPECT_LE(extreme.high, 1.0);
  const Interval certain = basic_logit_interval(1.0, {1.0, 1.0}, 0.95);
  EXPECT_EQ(certain.low, 1.0);
  EXPECT_EQ(certain.high, 1.0);
  EXPECT_THROW(basic_logit_interval(0.5, {0.5}, 0.95), std::invalid_argument);
  EXPECT_THROW(basic_logit_interval(0.5, {0.5, 0.5}, 95), std::invalid_argument);
}

TEST(Bootstrap, ResamplesWholeClustersWithReplacement) {
  Rng rng = stream(40, "counts");
  Eigen::VectorXi sum = Eigen::VectorXi::Zero(7);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::VectorXi counts = resample_counts(7, rng);
    EXPECT_EQ(counts.sum(), 7);
    sum += counts;
  }
  // Each is Binomial(7000, 1/7): two-sided exact bound at 1e-4 over 7 clusters.
  const boost::math::binomial expected(7000, 1.0 / 7.0);
  EXPECT_GE(sum.minCoeff(), boost::math::quantile(expected, 0.5e-4 / 7));
  EXPECT_LE(sum.maxCoeff(), boost::math::quantile(boost::math::complement(expected, 0.5e-4 / 7)));
  EXPECT_THROW(resample_counts(1, rng), std::invalid_argument);
}

constexpr int kClusters = 36;
constexpr int kChannels = 16;
constexpr int kKept = 6;
constexpr int kReplicates = 199;
constexpr int kDataSets = 1000;

// Found by tests/analysis/data/interval_coverage.py, numpy, 10,000 data sets of the same population.
constexpr double kBasicCoverage = 0.9210;
constexpr double kReferenceDataSets = 10000;

/// One data set: moments of recordings whose means are normal with 80 % of each channel's variance, the rest within.
std::vector<SampleStatistics> data_set(const Eigen::VectorXd& deviation, Rng& rng) {
  std::vector<SampleStatistics> clusters;
  for (int c = 0; c < kClusters; ++c) {
    const Eigen::VectorXd z = test::normal_matrix(kChannels, 1, rng);
    const Eigen::MatrixXd within = (0.2 * deviation.cwiseAbs2()).asDiagonal();
    clusters.push_back({30.0, std::sqrt(0.8) * deviation.cwiseProduct(z), within});
  }
  return clusters;
}

/// Number of data sets, two-sided exact binomial at 1e-4, that agrees with the reference simulation, whose own error
/// (3.9 standard errors: 1e-4) widens the bounds.
bool accepted(int covered) {
  const double error = 3.9 * std::sqrt(kBasicCoverage * (1 - kBasicCoverage) / kReferenceDataSets);
  const boost::math::binomial low(kDataSets, kBasicCoverage - error);
  const boost::math::binomial high(kDataSets, std::min(1.0, kBasicCoverage + error));
  return covered >= boost::math::quantile(low, 0.5e-4) &&
         covered <= boost::math::quantile(boost::math::complement(high, 0.5e-4));
}

TEST(CumulativeVarianceInterval, CoversAsFoundByIndependentSimulation) {
  Eigen::VectorXd deviation(kChannels);
  for (int i = 0; i < kChannels; ++i) deviation[i] = std::pow(0.8, i);
  const double truth = cumulative_variance(deviation.cwiseAbs2())[kKept - 1];
  int basic = 0;
  int percentile = 0;
  for (int i = 0; i < kDataSets; ++i) {
    Rng rng = test::numbered_stream(41, "data set/", i);
    const std::vector<SampleStatistics> clusters = data_set(deviation, rng);
    const double estimate = cumulative_variance(principal_axes(pooled(clusters)).variance)[kKept - 1];
    const Eigen::VectorXd shares = bootstrap_cumulative_variance(clusters, kReplicates, rng).col(kKept - 1);
    const std::vector<double> replicates(shares.begin(), shares.end());
    const Interval good = basic_logit_interval(estimate, replicates, 0.95);
    const Interval plain = percentile_interval(replicates, 0.95);
    basic += good.low <= truth && truth <= good.high ? 1 : 0;
    percentile += plain.low <= truth && truth <= plain.high ? 1 : 0;
  }
  RecordProperty("basic", basic);
  RecordProperty("percentile", percentile);
  std::cout << "of " << kDataSets << " intervals, basic " << basic << " and percentile " << percentile
            << " hold the true share\n";
  EXPECT_TRUE(accepted(basic)) << basic;
  EXPECT_FALSE(accepted(percentile)) << percentile;
}

}  // namespace
}  // namespace opponens::analysis
