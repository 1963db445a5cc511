// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/intervals.hpp"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>
#include <boost/math/distributions/beta.hpp>
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

/// Tables of the exact interval (as R's binom.test prints them), and its defining equations.
TEST(ProportionInterval, IsClopperAndPearsons) {
  const Interval none = proportion_interval(0, 10, 0.95);
  EXPECT_DOUBLE_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.3084971, 1e-7);
  const Interval half = proportion_interval(5, 10, 0.95);
  EXPECT_NEAR(half.low, 0.1870860, 1e-7);
  EXPECT_NEAR(half.high, 0.8129140, 1e-7);
  EXPECT_DOUBLE_EQ(proportion_interval(10, 10, 0.95).high, 1.0);
  for (const int events : {1, 7, 399}) {
    const Interval interval = proportion_interval(events, 400, 0.9);
    const boost::math::binomial_distribution<double> low(400, interval.low);
    const boost::math::binomial_distribution<double> high(400, interval.high);
    EXPECT_NEAR(boost::math::cdf(boost::math::complement(low, events - 1)), 0.05, 1e-9);
    EXPECT_NEAR(boost::math::cdf(high, events), 0.05, 1e-9);
  }
  EXPECT_THROW(static_cast<void>(proportion_interval(11, 10, 0.95)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(proportion_interval(0, 0, 0.95)), std::invalid_argument);
}

TEST(BasicLogitInterval, ReflectsAndStaysInside) {
  std::vector<double> replicates;
  for (int i = 1; i <= 199; ++i) replicates.push_back(0.90 + 0.0004 * i);
  const auto logit = [](double p) { return std::log(p / (1 - p)); };
  const Interval found = basic_logit_interval(0.93, replicates, 0.95);
  // The 5th and 195th of 199: (199 + 1) 0.025 = 5.
  EXPECT_NEAR(logit(found.low), 2 * logit(0.93) - logit(replicates[194]), 1e-12);
  EXPECT_NEAR(logit(found.high), 2 * logit(0.93) - logit(replicates[4]), 1e-12);
  const Interval certain = basic_logit_interval(1.0, {1.0, 1.0}, 0.95);
  EXPECT_EQ(certain.low, 1.0);
  EXPECT_EQ(certain.high, 1.0);
  EXPECT_THROW(basic_logit_interval(0.5, {0.5}, 0.95), std::invalid_argument);
  EXPECT_THROW(basic_logit_interval(0.5, {0.5, 0.5}, 95), std::invalid_argument);
}

TEST(BasicLogitInterval, ReplicatesWithoutALogitAreNotReflected) {
  // A joint that moved in one recording of many: a third of the resamples lack it, and their share is 1. Reflected, the
  // low end would be near 0.
  std::vector<double> replicates(200, 1.0);
  for (int i = 0; i < 130; ++i) replicates[static_cast<std::size_t>(i)] = 1.0 - 1e-5 * (1 + i % 3);
  const Interval found = basic_logit_interval(1.0 - 1e-5, replicates, 0.95);
  EXPECT_DOUBLE_EQ(found.low, 1.0 - 3e-5);
  EXPECT_EQ(found.high, 1.0);
  const Interval stretched = basic_logit_interval(0.99, {0.995, 0.999, 1.0, 1.0}, 0.95);
  EXPECT_EQ(stretched.low, 0.99);
  EXPECT_EQ(stretched.high, 1.0);
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
constexpr int kFew = 5;
constexpr int kFewKept = 3;
constexpr double kJackknifeCoverage = 0.8402;  // of 5 recordings, first 3 axes
constexpr double kReferenceDataSets = 10000;

/// One data set: moments of recordings whose means are normal with 80 % of each channel's variance, the rest within.
std::vector<SampleStatistics> data_set(int count, const Eigen::VectorXd& deviation, Rng& rng) {
  std::vector<SampleStatistics> clusters;
  for (int c = 0; c < count; ++c) {
    const Eigen::VectorXd z = test::normal_matrix(kChannels, 1, rng);
    const Eigen::MatrixXd within = (0.2 * deviation.cwiseAbs2()).asDiagonal();
    clusters.push_back({30.0, std::sqrt(0.8) * deviation.cwiseProduct(z), within});
  }
  return clusters;
}

/// Number of data sets, two-sided exact binomial at 1e-4, that agrees with the reference simulation, whose own error
/// (3.9 standard errors: 1e-4) widens the bounds.
bool accepted(int covered, double reference) {
  const double error = 3.9 * std::sqrt(reference * (1 - reference) / kReferenceDataSets);
  const boost::math::binomial low(kDataSets, reference - error);
  const boost::math::binomial high(kDataSets, std::min(1.0, reference + error));
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
    const std::vector<SampleStatistics> clusters = data_set(kClusters, deviation, rng);
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
  EXPECT_TRUE(accepted(basic, kBasicCoverage)) << basic;
  EXPECT_FALSE(accepted(percentile, kBasicCoverage)) << percentile;
}

TEST(CumulativeVarianceInterval, OfFewClustersIsTheJackknifes) {
  Eigen::VectorXd deviation(kChannels);
  for (int i = 0; i < kChannels; ++i) deviation[i] = std::pow(0.8, i);
  const double truth = cumulative_variance(deviation.cwiseAbs2())[kFewKept - 1];
  const auto holds = [&](const Interval& one) { return one.low <= truth && truth <= one.high ? 1 : 0; };
  int jackknife = 0;
  int resampled = 0;
  for (int i = 0; i < kDataSets; ++i) {
    Rng rng = test::numbered_stream(44, "few clusters/", i);
    const std::vector<SampleStatistics> clusters = data_set(kFew, deviation, rng);
    jackknife += holds(cumulative_variance_intervals(clusters, kReplicates, 0.95, rng)[kFewKept - 1]);
    const double estimate = cumulative_variance(principal_axes(pooled(clusters)).variance)[kFewKept - 1];
    const Eigen::VectorXd shares = bootstrap_cumulative_variance(clusters, kReplicates, rng).col(kFewKept - 1);
    resampled += holds(basic_logit_interval(estimate, {shares.begin(), shares.end()}, 0.95));
  }
  std::cout << "of " << kDataSets << " intervals of " << kFew << " clusters, jackknife " << jackknife
            << " and resampled " << resampled << " hold the true share\n";
  EXPECT_TRUE(accepted(jackknife, kJackknifeCoverage)) << jackknife;
  EXPECT_FALSE(accepted(resampled, kJackknifeCoverage)) << resampled;
}

TEST(CumulativeVarianceInterval, OfFewClustersThatAreAlikeIsNarrowAndOfOneMovingJointCertain) {
  SampleStatistics one{10.0, Eigen::Vector3d::Zero(), Eigen::Vector3d(3, 1, 0).asDiagonal()};
  const auto alike = jackknife_intervals({one, one, one, one}, 0.95);
  EXPECT_NEAR(alike[0].low, 0.75, 1e-12);
  EXPECT_NEAR(alike[0].high, 0.75, 1e-12);
  EXPECT_DOUBLE_EQ(alike[2].low, 1.0);
  EXPECT_DOUBLE_EQ(alike[2].high, 1.0);
  EXPECT_THROW(jackknife_intervals({one}, 0.95), std::invalid_argument);
}

/// Low and high end, as probabilities under the two beta distributions of Clopper and Pearson, must be the 2.5 % tails.
/// An end is the 500th of 19,999 replicates, so its probability is Beta(500, 19500): two-sided bound at 1e-4.
void expect_clopper_pearson(int successes, int clusters, const Interval& found) {
  const boost::math::beta_distribution<> tail(500, 19500);
  const auto in_tail = [&](double p) {
    return p >= boost::math::quantile(tail, 0.5e-4) &&
           p <= boost::math::quantile(boost::math::complement(tail, 0.5e-4));
  };
  const int failures = clusters - successes;
  EXPECT_TRUE(in_tail(boost::math::cdf(boost::math::beta_distribution<>(successes, failures + 1), found.low)));
  if (failures == 0) {
    EXPECT_EQ(found.high, 1.0);
    return;
  }
  const boost::math::beta_distribution<> above(successes + 1, failures);
  EXPECT_TRUE(in_tail(boost::math::cdf(boost::math::complement(above, found.high))));
}

TEST(RatioInterval, WholeClustersInOrOutGiveClopperAndPearson) {
  constexpr int kAll = 20;
  for (const int successes : {20, 17, 10}) {
    SCOPED_TRACE(successes);
    Rng rng = test::numbered_stream(42, "in or out/", successes);
    Eigen::VectorXd inside = Eigen::VectorXd::Zero(kAll);
    inside.head(successes).setConstant(50.0);
    expect_clopper_pearson(successes, kAll,
                           ratio_interval(inside, Eigen::VectorXd::Constant(kAll, 50.0), 19999, 0.95, rng));
  }
  Rng rng = stream(42, "bad");
  EXPECT_THROW(ratio_interval(Eigen::Vector2d(1, 3), Eigen::Vector2d(2, 2), 99, 0.95, rng), std::invalid_argument);
  EXPECT_THROW(ratio_interval(Eigen::Vector2d(0, 0), Eigen::Vector2d(2, 0), 99, 0.95, rng), std::invalid_argument);
}

/// How often each kind of interval holds the truth, of kDataSets.
struct Held {
  int found = 0;
  int percentile = 0;
  int reflected = 0;  ///< basic on the logit
};

/// Clusters of 100 samples. Most are wholly inside; with the given probability one is not, and has each sample outside
/// with a probability that is uniform in [0, 0.2].
Held held_by_intervals(int clusters, double imperfect, int number) {
  const double truth = 1.0 - 0.1 * imperfect;
  const Eigen::VectorXd total = Eigen::VectorXd::Constant(clusters, 100.0);
  const auto holds = [&](const Interval& interval) { return interval.low <= truth && truth <= interval.high ? 1 : 0; };
  Held held;
  for (int i = 0; i < kDataSets; ++i) {
    Rng rng = test::numbered_stream(43, "few imperfect/" + std::to_string(number) + "/", i);
    Eigen::VectorXd inside = total;
    for (double& count : inside) {
      if (rng.uniform() >= imperfect) continue;
      const double outside = rng.uniform(0.0, 0.2);
      for (int sample = 0; sample < 100; ++sample) count -= rng.uniform() < outside ? 1.0 : 0.0;
    }
    held.found += holds(ratio_interval(inside, total, kReplicates, 0.95, rng));
    std::vector<double> shares;
    for (int replicate = 0; replicate < kReplicates; ++replicate) {
      const Eigen::VectorXd counts = resample_counts(clusters, rng).cast<double>();
      shares.push_back(counts.dot(inside) / counts.dot(total));
    }
    held.percentile += holds(percentile_interval(shares, 0.95));
    held.reflected += holds(basic_logit_interval(inside.sum() / total.sum(), shares, 0.95));
  }
  return held;
}

TEST(RatioInterval, HoldsItsLevelWhenFewClustersAreImperfect) {
  // Null: an interval that holds the truth with probability 0.95 or more; then the count is at least what
  // Binomial(1000, 0.95) gives, one-sided exact bound at 1e-4. Resampling must be found out.
  const int least = static_cast<int>(boost::math::quantile(boost::math::binomial(kDataSets, 0.95), 1e-4));
  int number = 0;
  for (const int clusters : {6, 12, 36}) {
    for (const double imperfect : {0.08, 0.3}) {
      const Held held = held_by_intervals(clusters, imperfect, number++);
      std::cout << clusters << " clusters, " << 100 * imperfect << " % imperfect: of " << kDataSets << " intervals "
                << held.found << " hold the share, percentile " << held.percentile << ", basic on the logit "
                << held.reflected << "\n";
      EXPECT_GE(held.found, least);
      if (imperfect > 0.1 && clusters == 36) continue;  // enough imperfect ones for any kind
      EXPECT_LT(held.percentile, least);
      EXPECT_LT(held.reflected, least);
    }
  }
}

}  // namespace
}  // namespace opponens::analysis
