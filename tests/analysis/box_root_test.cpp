// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What share of normal samples the box holds, for every number of joints and each rule of its root.

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/statistics.hpp"
#include "analysis/synergy_box.hpp"
#include "tests/analysis/binomial_bound.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

constexpr int kSamples = 20000;
constexpr double kAlpha = 0.05;

/// How many of kSamples normal samples of n joints with the given standard deviations lie in the box of all n axes.
double inside(int n, const Eigen::VectorXd& half_width, const Eigen::VectorXd& deviation) {
  Rng rng = test::numbered_stream(20, "box root/", n);
  const Eigen::MatrixXd samples = test::normal_matrix(kSamples, n, rng) * deviation.asDiagonal();
  double count = 0;
  for (Eigen::Index i = 0; i < samples.rows(); ++i) {
    count += (samples.row(i).transpose().array().abs() <= half_width.array()).all() ? 1 : 0;
  }
  return count;
}

class BoxRootTest : public testing::TestWithParam<int> {
 protected:
  const int n = GetParam();
  const Eigen::VectorXd deviation = Eigen::VectorXd::LinSpaced(n, 1.0, 0.1);

  double count(BoxRoot root, int k) const {
    return inside(n, box_half_width(deviation.cwiseAbs2(), kAlpha, root, n, k), deviation);
  }
};

// Null of all three: kSamples independent normal samples fall into a box whose axes hold p each with probability p^n,
// so the count is Binomial(kSamples, p^n). False-alarm rate 1e-4 each. Fixed seeds.

TEST_P(BoxRootTest, TheNthRootHolds95PercentForEveryN) {
  EXPECT_TRUE(test::is_binomial(count(BoxRoot::n, n), kSamples, 1.0 - kAlpha));
}

TEST_P(BoxRootTest, ThePrintedSquareRootHoldsItForTwoJointsOnly) {
  const double found = count(BoxRoot::literal, n);
  EXPECT_TRUE(test::is_binomial(found, kSamples, std::pow(1.0 - kAlpha, n / 2.0))) << found / kSamples;
  EXPECT_EQ(test::is_binomial(found, kSamples, 1.0 - kAlpha), n == 2) << found / kSamples;
}

TEST_P(BoxRootTest, TheKthRootHoldsItForTheKeptCoordinatesOnly) {
  const int k = (n + 1) / 2;
  const double all = count(BoxRoot::k, k);
  EXPECT_TRUE(test::is_binomial(all, kSamples, std::pow(1.0 - kAlpha, static_cast<double>(n) / k))) << all / kSamples;
  EXPECT_EQ(test::is_binomial(all, kSamples, 1.0 - kAlpha), k == n) << all / kSamples;
  const Eigen::VectorXd kept = deviation.head(k);
  const double found = inside(k, box_half_width(kept.cwiseAbs2(), kAlpha, BoxRoot::k, n, k), kept);
  EXPECT_TRUE(test::is_binomial(found, kSamples, 1.0 - kAlpha)) << found / kSamples;
}

INSTANTIATE_TEST_SUITE_P(Joints, BoxRootTest, testing::Range(1, 17));

}  // namespace
}  // namespace opponens::analysis
