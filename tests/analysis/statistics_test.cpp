// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/statistics.hpp"

#include <gtest/gtest.h>

#include "analysis/subspace.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

using test::normal_matrix;

TEST(Moments, HandComputed) {
  Eigen::MatrixXd q(3, 2);
  q << 1, 0, 2, 3, 6, 3;
  const SampleStatistics s = moments(q, 2.0);
  EXPECT_DOUBLE_EQ(s.count, 6.0);
  EXPECT_TRUE(s.mean.isApprox(Eigen::Vector2d(3, 2)));
  Eigen::Matrix2d covariance;
  covariance << 14.0 / 3, 2, 2, 2;
  EXPECT_TRUE(s.covariance.isApprox(covariance, 1e-14));
}

TEST(Moments, LargeMeanCostsNoDigits) {
  Rng rng = stream(1, "moments");
  const Eigen::MatrixXd q = normal_matrix(200, 4, rng);
  const Eigen::MatrixXd shifted = q.array() + 1e6;
  EXPECT_TRUE(moments(shifted).covariance.isApprox(moments(q).covariance, 1e-9));
  // The textbook formula E[xx'] - E[x]E[x]' would fail this: it loses 12 of 16 digits at this mean.
  const Eigen::VectorXd mean = shifted.colwise().mean();
  const Eigen::MatrixXd naive = shifted.transpose() * shifted / 200.0 - mean * mean.transpose();
  EXPECT_FALSE(naive.isApprox(moments(q).covariance, 1e-9));
}

TEST(Moments, MergeEqualsOnePass) {
  Rng rng = stream(2, "merge");
  const Eigen::MatrixXd q = normal_matrix(57, 6, rng);
  const SampleStatistics whole = moments(q);
  for (const int cut : {1, 20, 56}) {
    const SampleStatistics parts = merge(moments(q.topRows(cut)), moments(q.bottomRows(57 - cut)));
    EXPECT_DOUBLE_EQ(parts.count, 57.0);
    EXPECT_TRUE(parts.mean.isApprox(whole.mean, 1e-13)) << cut;
    EXPECT_TRUE(parts.covariance.isApprox(whole.covariance, 1e-13)) << cut;
  }
  EXPECT_TRUE(merge(SampleStatistics{}, whole).covariance == whole.covariance);
}

TEST(Moments, WeightTwoEqualsRepeating) {
  Rng rng = stream(3, "weights");
  const Eigen::MatrixXd a = normal_matrix(10, 3, rng);
  const Eigen::MatrixXd b = normal_matrix(15, 3, rng);
  const SampleStatistics weighted = pooled({moments(a, 2.0), moments(b, 1.0)});
  const SampleStatistics repeated = pooled({moments(a), moments(a), moments(b)});
  EXPECT_DOUBLE_EQ(weighted.count, repeated.count);
  EXPECT_TRUE(weighted.covariance.isApprox(repeated.covariance, 1e-13));
}

TEST(Moments, BrokenContracts) {
  Eigen::MatrixXd q = Eigen::MatrixXd::Ones(3, 2);
  EXPECT_THROW(moments(q, 0.0), std::invalid_argument);
  EXPECT_THROW(moments(Eigen::MatrixXd(0, 2)), std::invalid_argument);
  q(1, 1) = std::nan("");
  EXPECT_THROW(moments(q), std::invalid_argument);
  EXPECT_THROW(scaled(moments(Eigen::MatrixXd::Ones(3, 2)), Eigen::Vector2d(1, 0)), std::invalid_argument);
}

/// 8 channels: 2 = constant, 5 = 0.6 x channel 4, 7 = channel 0 - channel 1, all rounded to the sensor's resolution.
Eigen::MatrixXd glove_like(double resolution, Rng& rng) {
  Eigen::MatrixXd q = 0.4 * normal_matrix(400, 8, rng);
  q.col(2).setConstant(0.3);
  q.col(5) = 0.6 * q.col(4);
  q.col(7) = q.col(0) - q.col(1);
  if (resolution > 0) q = (q / resolution).array().round() * resolution;
  return q;
}

TEST(EffectiveSubspace, NamesConstantAndDependentChannels) {
  for (const double resolution : {0.0, 0.0087}) {
    Rng rng = stream(4, "subspace");
    const SampleStatistics s = moments(glove_like(resolution, rng));
    const EffectiveSubspace found = effective_subspace(s.covariance, Eigen::VectorXd::Constant(8, resolution));
    EXPECT_EQ(found.dof(), 5) << resolution;
    ASSERT_EQ(found.dropped.size(), 3u);
    // Which of three dependent channels goes is decided by the pivots: the one that adds least to those taken before.
    const std::vector<std::string> names{"a", "b", "constant", "d", "e", "dip", "g", "difference"};
    const std::vector<std::string> dropped = names_at(names, found.dropped);
    EXPECT_EQ(std::count(dropped.begin(), dropped.end(), "constant"), 1);
    EXPECT_EQ(std::count(dropped.begin(), dropped.end(), "dip"), 1);
  }
}

TEST(EffectiveSubspace, KeptChannelsAreIndependentAndSpanTheRest) {
  for (int trial = 0; trial < 50; ++trial) {
    Rng rng = test::numbered_stream(5, "span/", trial);
    const int rank = 1 + trial % 6;
    const Eigen::MatrixXd q = normal_matrix(100, rank, rng) * normal_matrix(rank, 7, rng);
    const SampleStatistics s = moments(q);
    const EffectiveSubspace found = effective_subspace(s.covariance, Eigen::VectorXd::Zero(7));
    EXPECT_EQ(found.dof(), rank) << "trial " << trial;
  }
}

TEST(EffectiveSubspace, NothingMoves) {
  const EffectiveSubspace found = effective_subspace(Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Zero(3));
  EXPECT_EQ(found.dof(), 0);
  EXPECT_EQ(found.dropped, (std::vector<int>{0, 1, 2}));
}

}  // namespace
}  // namespace opponens::analysis
