// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/min_weight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.hpp"
#include "grasp/origin_ball.hpp"
#include "grasp/quality.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

TEST(MinWeight, BalancedSetHasEqualWeights) {
  Matrix6Xd w(6, 12);
  w << Eigen::Matrix<double, 6, 6>::Identity(), -Eigen::Matrix<double, 6, 6>::Identity();
  const MinWeight solution = min_weight(w);
  ASSERT_EQ(solution.state, MinWeight::State::optimal);
  EXPECT_NEAR(solution.value, 1.0 / 12.0, 1e-15);
  EXPECT_NEAR((solution.weights.array() - 1.0 / 12.0).abs().maxCoeff(), 0.0, 1e-15);
}

TEST(MinWeight, TwoPointsOnALineByHand) {
  // a_1 - 3 a_2 = 0, a_1 + a_2 = 1: a = (3/4, 1/4), so l* = 1/4; both to the right: a = (3/2, -1/2).
  Matrix6Xd w = Matrix6Xd::Zero(6, 2);
  w.row(0) << 1.0, -3.0;
  EXPECT_NEAR(min_weight(w).value, 0.25, 1e-15);
  w.row(0) << 1.0, 3.0;
  EXPECT_NEAR(min_weight(w).value, -0.5, 1e-14);
}

TEST(MinWeight, NoBalanceWhenTheOriginIsOffTheAffineHull) {
  Matrix6Xd w = Matrix6Xd::Random(6, 20);
  w.row(3).setOnes();
  EXPECT_EQ(min_weight(w).state, MinWeight::State::no_balance);
  EXPECT_EQ(min_weight(Matrix6Xd(6, 0)).state, MinWeight::State::no_balance);
}

// Optimality is proven by the answer itself: primal and dual feasible with equal values.
TEST(MinWeight, PrimalAndDualCertifyEachOther) {
  Rng rng = stream(21, "certificate");
  int positive = 0;
  for (int i = 0; i < 2000; ++i) {
    const Matrix6Xd w = contact_wrenches(test::random_contacts(3 + static_cast<int>(rng.index(8)), 0.8, rng), {});
    const MinWeight solution = min_weight(w);
    ASSERT_EQ(solution.state, MinWeight::State::optimal) << "set " << i;
    const double size = 1.0 + solution.weights.cwiseAbs().maxCoeff();
    EXPECT_NEAR((w * solution.weights).norm(), 0.0, 1e-10 * size);
    EXPECT_NEAR(solution.weights.sum(), 1.0, 1e-11 * size);
    EXPECT_GE(solution.weights.minCoeff(), solution.value - 1e-15);
    const Vector6d mean = w.rowwise().mean();
    const double n = static_cast<double>(w.cols());
    const double z = 1.0 / n - mean.dot(solution.dual);  // dual objective
    EXPECT_NEAR(z, solution.value, 1e-9 * size);
    EXPECT_GE((solution.dual.transpose() * w).minCoeff() + z, -1e-9 * size);  // dual feasibility
    positive += solution.value > 0.0;
  }
  EXPECT_GT(positive, 300);
  EXPECT_LT(positive, 1700);
}

TEST(MinWeight, IsAttainedOnIllConditionedSets) {
  Rng rng = stream(23, "clusters");
  for (int i = 0; i < 4000; ++i) {
    const double apart = std::pow(10.0, -rng.uniform(1.0, 6.0));
    const Matrix6Xd w = contact_wrenches(test::clustered_contacts(3 + static_cast<int>(rng.index(4)), apart, rng), {});
    const MinWeight solution = min_weight(w);
    ASSERT_EQ(solution.state, MinWeight::State::optimal) << "set " << i;
    const double size = 1.0 + solution.weights.cwiseAbs().maxCoeff();
    ASSERT_NEAR((w * solution.weights).norm(), 0.0, 1e-11 * size) << "set " << i << ", " << apart << " apart";
    ASSERT_NEAR(solution.weights.sum(), 1.0, 1e-11 * size);
    ASSERT_GE(solution.weights.minCoeff(), solution.value - 1e-15);
    const double z = 1.0 / static_cast<double>(w.cols()) - w.rowwise().mean().dot(solution.dual);
    ASSERT_GE((solution.dual.transpose() * w).minCoeff() + z, -1e-9 * size) << "set " << i << ", " << apart << " apart";
  }
}

TEST(MinWeight, SignAgreesWithEpsilonOnTenThousandMixedSets) {
  Rng rng = stream(22, "sign");
  int inside = 0;
  for (int i = 0; i < 10000; ++i) {
    QualityConvention convention;
    convention.edges = 3 + static_cast<int>(rng.index(6));
    const int contacts = 3 + static_cast<int>(rng.index(5));
    const Matrix6Xd w = contact_wrenches(test::random_contacts(contacts, rng.uniform(0.0, 1.2), rng), convention);
    const OriginBall ball = largest_origin_ball(WrenchSpace(w, convention.edges, WrenchNorm::l1));
    const MinWeight solution = min_weight(w);
    ASSERT_EQ(solution.state, MinWeight::State::optimal);
    ASSERT_EQ(ball.inside, solution.value > 0.0) << "set " << i << ": " << ball.radius << ", " << solution.value;
    ASSERT_EQ(ball.inside, ball.radius > 0.0);
    inside += ball.inside;
  }
  EXPECT_GT(inside, 2000);
  EXPECT_LT(inside, 8000);
}

TEST(MinWeight, GradientEqualsCentralDifferences) {
  Rng rng = stream(23, "gradient");
  int compared = 0;
  double largest = 0.0;
  for (int i = 0; i < 60; ++i) {
    QualityConvention convention;
    convention.edges = 3;
    Matrix6Xd w = contact_wrenches(test::random_contacts(4, 0.5, rng), convention);
    for (double& value : w.reshaped()) value += 0.05 * rng.normal();  // generic: the optimum is unique
    const Matrix6Xd gradient = min_weight_gradient(min_weight(w));
    for (int k = 0; k < 10; ++k) {
      const auto row = static_cast<Eigen::Index>(rng.index(6));
      const auto column = static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(w.cols())));
      const double center = w(row, column);
      const double h = 1e-6;
      w(row, column) = center + h;
      const double up = min_weight(w).value;
      w(row, column) = center - h;
      const double down = min_weight(w).value;
      w(row, column) = center;
      EXPECT_NEAR(gradient(row, column), (up - down) / (2.0 * h), 1e-6 * (1.0 + std::abs(gradient(row, column))))
          << "set " << i;
      largest = std::max(largest, std::abs(gradient(row, column)));
      ++compared;
    }
  }
  EXPECT_EQ(compared, 600);
  EXPECT_GT(largest, 1e-2);  // the two sides are not both zero
}

}  // namespace
}  // namespace opponens::grasp
