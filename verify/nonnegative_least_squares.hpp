// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opponens::verify {

struct NonnegativeSolution {
  Eigen::VectorXd x;       ///< [n], >= 0
  double residual = 0.0;   ///< |A x - b|
  bool converged = false;  ///< the optimality conditions hold to the tolerance, or rounding lets nothing more be gained
};

/// min |A x - b| subject to x >= 0: the active set method of Lawson and Hanson (Solving Least Squares Problems, 1974,
/// chapter 23). A: [m x n], b: [m]. Ends when no inactive gradient entry exceeds 1e-12 (|A| |b|), or after 10 n steps.
NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

}  // namespace opponens::verify
