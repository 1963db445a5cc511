// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/nonnegative_least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <Eigen/QR>

#include "core/rng.hpp"

namespace opponens::verify {
namespace {

/// The best of all 2^n active sets.
double residual_by_enumeration(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  double best = b.norm();
  for (unsigned set = 1; set < (1U << A.cols()); ++set) {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      if ((set >> j) & 1U) columns.push_back(j);
    }
    const Eigen::MatrixXd part = A(Eigen::all, columns);
    const Eigen::VectorXd x = part.colPivHouseholderQr().solve(b);
    if ((x.array() >= 0.0).all()) best = std::min(best, (part * x - b).norm());
  }
  return best;
}

TEST(NonnegativeLeastSquares, HandComputed) {
  Eigen::Matrix2d A;
  A << 1, 0, 0, 1;
  const auto inside = nonnegative_least_squares(A, Eigen::Vector2d(2, 3));
  EXPECT_TRUE(inside.x.isApprox(Eigen::Vector2d(2, 3)));
  EXPECT_NEAR(inside.residual, 0.0, 1e-15);
  const auto outside = nonnegative_least_squares(A, Eigen::Vector2d(2, -3));
  EXPECT_TRUE(outside.x.isApprox(Eigen::Vector2d(2, 0)));
  EXPECT_DOUBLE_EQ(outside.residual, 3.0);
  EXPECT_TRUE(outside.converged);
  EXPECT_DOUBLE_EQ(nonnegative_least_squares(A, Eigen::Vector2d(-1, -1)).residual, std::sqrt(2.0));
  EXPECT_THROW(nonnegative_least_squares(A, Eigen::Vector3d(1, 1, 1)), std::invalid_argument);
}

TEST(NonnegativeLeastSquares, IsTheBestOfAllActiveSets) {
  Rng rng = stream(1, "test/nnls");
  int at_bound = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto rows = static_cast<Eigen::Index>(2 + rng.index(5));
    const auto columns = static_cast<Eigen::Index>(1 + rng.index(8));
    Eigen::MatrixXd A(rows, columns);
    Eigen::VectorXd b(rows);
    for (double& value : A.reshaped()) value = rng.normal();
    for (double& value : b) value = rng.normal();
    const auto solution = nonnegative_least_squares(A, b);
    ASSERT_TRUE(solution.converged) << "trial " << trial;
    ASSERT_TRUE((solution.x.array() >= 0.0).all());
    ASSERT_NEAR(solution.residual, residual_by_enumeration(A, b), 1e-9) << "trial " << trial;
    ASSERT_NEAR(solution.residual, (A * solution.x - b).norm(), 1e-12);
    if ((solution.x.array() == 0.0).any()) ++at_bound;
  }
  EXPECT_GT(at_bound, 100);
}

// Groups of nearly equal columns, as contacts side by side make them: a solution exists, and each step towards it has a
// gradient as small as the columns' difference.
TEST(NonnegativeLeastSquares, FindsTheSolutionAmongNearlyEqualColumns) {
  Rng rng = stream(2, "test/nnls");
  for (int trial = 0; trial < 300; ++trial) {
    const double apart = std::pow(10.0, -rng.uniform(1.0, 6.0));
    Eigen::MatrixXd A(6, 48);
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      for (double& value : A.col(j)) value = rng.normal();
      if (j % 8 != 0) A.col(j) = A.col(j - j % 8) + apart * A.col(j);
    }
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A.cols());
    for (int i = 0; i < 12; ++i) x[static_cast<Eigen::Index>(rng.index(48))] += rng.uniform();
    const Eigen::VectorXd b = A * x;
    const auto solution = nonnegative_least_squares(A, b);
    ASSERT_TRUE(solution.converged) << "trial " << trial;
    ASSERT_LE(solution.residual, 1e-11 * b.norm()) << "trial " << trial << ", " << apart << " apart";
    // A companion that has none: along the last axis all columns point up, b down.
    A.row(5) = A.row(5).cwiseAbs();
    Eigen::VectorXd below = A * x;
    below[5] = -1.0;
    ASSERT_GE(nonnegative_least_squares(A, below).residual, 1.0 - 1e-12);
  }
}

}  // namespace
}  // namespace opponens::verify
