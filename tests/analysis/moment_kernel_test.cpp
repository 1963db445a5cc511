// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/moment_kernel.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

/// Mean and covariance in extended precision, in two passes: independent of the kernel's order and shift.
SampleStatistics reference(const Eigen::MatrixXd& q) {
  const auto rows = static_cast<long double>(q.rows());
  Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic> x = q.cast<long double>();
  const Eigen::Matrix<long double, 1, Eigen::Dynamic> mean = x.colwise().sum() / rows;
  x.rowwise() -= mean;
  return {static_cast<double>(q.rows()), mean.transpose().cast<double>(), (x.transpose() * x / rows).cast<double>()};
}

/// Largest error of a covariance relative to the two standard deviations it belongs to.
double relative_error(const SampleStatistics& found, const SampleStatistics& expected) {
  const Eigen::VectorXd deviation = expected.covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd error = found.covariance - expected.covariance;
  return (error.array() / (deviation * deviation.transpose()).array()).abs().maxCoeff();
}

bool equal(const SampleStatistics& a, const SampleStatistics& b) {
  return a.count == b.count && a.mean == b.mean && a.covariance == b.covariance;
}

TEST(MomentKernel, EveryInstructionSetGivesTheSameBits) {
  Rng rng = stream(60, "levels");
  for (const Eigen::Index columns : {1, 3, 4, 5, 16, 22, 23}) {
    for (const Eigen::Index rows : {1, 2, 63, 64, 65, 517, 4096}) {
      const Eigen::MatrixXd q = test::normal_matrix(rows, columns, rng);
      const Eigen::VectorXd origin = test::normal_matrix(columns, 1, rng);
      const SampleStatistics baseline = leaf_moments({q.data(), rows, columns, 1, rows}, origin, SimdLevel::baseline);
      for (const SimdLevel level : simd_levels()) {
        EXPECT_TRUE(equal(leaf_moments({q.data(), rows, columns, 1, rows}, origin, level), baseline))
            << rows << " " << columns;
      }
      // Another order of additions does not: the comparison can fail.
      const Eigen::MatrixXd reversed = q.colwise().reverse();
      if (rows < 64 || columns < 16) continue;
      EXPECT_FALSE(
          equal(leaf_moments({reversed.data(), rows, columns, 1, rows}, origin, SimdLevel::baseline), baseline));
    }
  }
}

TEST(MomentKernel, AgreesWithExtendedPrecision) {
  Rng rng = stream(60, "precision");
  for (const Eigen::Index rows : {2, 84, 4097, 20000}) {
    const Eigen::MatrixXd mixing = test::normal_matrix(16, 16, rng);
    const Eigen::MatrixXd q = test::normal_matrix(rows, 16, rng) * mixing;
    const SampleStatistics expected = reference(q);
    EXPECT_LT(relative_error(moments(q), expected), 1e-13) << rows;
    // Of the deviations: samples of that size are added, and what is left of the mean is smaller by sqrt(rows).
    const Eigen::ArrayXd error = (moments(q).mean - expected.mean).array().abs();
    EXPECT_LT((error / expected.covariance.diagonal().array().sqrt()).maxCoeff(), 1e-14) << rows;
  }
}

TEST(MomentKernel, LargeMeanSmallSpread) {
  Rng rng = stream(60, "large mean");
  Eigen::MatrixXd q = 1e-3 * test::normal_matrix(50000, 7, rng);
  q.array() += 1e6;
  EXPECT_LT(relative_error(moments(q), reference(q)), 1e-12);
  // The textbook formula on the same numbers is worthless.
  const Eigen::VectorXd mean = q.colwise().mean().transpose();
  const Eigen::MatrixXd textbook = q.transpose() * q / 50000.0 - mean * mean.transpose();
  EXPECT_GT(relative_error({50000.0, mean, textbook}, reference(q)), 1.0);
}

TEST(MomentKernel, AFirstChunkFarFromTheRestCostsFewDigits) {
  Rng rng = stream(60, "jump");
  Eigen::MatrixXd q = 1e-3 * test::normal_matrix(4096, 4, rng);
  q.bottomRows(4096 - 64).array() += 1e6;
  EXPECT_LT(relative_error(moments(q), reference(q)), 1e-12);
}

TEST(MomentKernel, ThreadsAndLayoutDoNotMatterAndChunksHardly) {
  Rng rng = stream(60, "threads");
  const Eigen::MatrixXd q = test::normal_matrix(30011, 16, rng).array() + 100.0;
  const SampleStatistics one = moments(q, 2.5);
  EXPECT_EQ(one.count, 2.5 * 30011);
  for (const int threads : {2, 3, 16}) EXPECT_TRUE(equal(moments(q, 2.5, threads), one)) << threads;
  EXPECT_TRUE(equal(moments_of_rows(q, 2.5, 2), one));
  EXPECT_TRUE(equal(moments(Eigen::MatrixXd(q.leftCols(5))), moments(q.leftCols(5))));
  const Eigen::MatrixXd wide = q.transpose();
  EXPECT_TRUE(equal(moments_of_rows(wide.transpose(), 2.5), one));
  for (const Eigen::Index part : {1, 84, 1000, 4095, 29999}) {
    PairwiseMerge tree;
    for (Eigen::Index row = 0; row < q.rows(); row += part) {
      tree.add(moments(q.middleRows(row, std::min(part, q.rows() - row)), 2.5));
    }
    EXPECT_LT(relative_error(tree.result(), one), 1e-12) << part;
    EXPECT_LT((tree.result().mean - one.mean).norm() / one.mean.norm(), 1e-12) << part;
  }
  EXPECT_FALSE(equal(moments(q.topRows(30010), 2.5), one));
}

TEST(MomentKernel, ConstantColumnsHaveNoVarianceAndNonFiniteValuesAreRefused) {
  Rng rng = stream(60, "constant");
  Eigen::MatrixXd q = test::normal_matrix(5000, 3, rng);
  q.col(1).setConstant(0.3);
  const SampleStatistics found = moments(q);
  EXPECT_EQ(found.covariance(1, 1), 0.0);
  EXPECT_EQ(found.covariance(1, 2), 0.0);
  EXPECT_EQ(found.mean[1], 0.3);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    Eigen::MatrixXd broken = q;
    broken(4999, 2) = bad;
    EXPECT_THROW(moments(broken), std::invalid_argument) << bad;
    EXPECT_THROW(moments_of_rows(broken), std::invalid_argument) << bad;
  }
  EXPECT_THROW(moments(q, 1.0, 0), std::invalid_argument);
}

TEST(PairwiseMerge, IsATreeInFixedOrder) {
  Rng rng = stream(60, "tree");
  std::vector<SampleStatistics> parts;
  for (int i = 0; i < 5; ++i) parts.push_back(moments(test::normal_matrix(10, 3, rng)));
  const SampleStatistics expected = merge(merge(merge(parts[0], parts[1]), merge(parts[2], parts[3])), parts[4]);
  EXPECT_TRUE(equal(pooled(parts), expected));
  EXPECT_EQ(PairwiseMerge().result().count, 0.0);
}

}  // namespace
}  // namespace opponens::analysis
