// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/nonnegative_least_squares.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/QR>

#include "core/require.hpp"

namespace opponens::verify {
namespace {

/// Unconstrained least squares over the passive columns; zero elsewhere.
Eigen::VectorXd solve_passive(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const std::vector<bool>& passive) {
  std::vector<Eigen::Index> columns;
  for (std::size_t j = 0; j < passive.size(); ++j) {
    if (passive[j]) columns.push_back(static_cast<Eigen::Index>(j));
  }
  Eigen::VectorXd z = Eigen::VectorXd::Zero(A.cols());
  const Eigen::MatrixXd kept = A(Eigen::all, columns);
  const auto qr = kept.colPivHouseholderQr();
  Eigen::VectorXd s = qr.solve(b);
  s += qr.solve(b - kept * s);
  for (std::size_t i = 0; i < columns.size(); ++i) z[columns[i]] = s[static_cast<Eigen::Index>(i)];
  return z;
}

/// Lawson and Hanson's inner loop: from x towards the passive solution, dropping columns that would turn negative.
Eigen::VectorXd feasible_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, Eigen::VectorXd x,
                                  std::vector<bool>& passive) {
  while (std::find(passive.begin(), passive.end(), true) != passive.end()) {
    Eigen::VectorXd z = solve_passive(A, b, passive);
    double alpha = 1.0;
    for (std::size_t i = 0; i < passive.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      if (passive[i] && z[j] <= 0.0) alpha = std::min(alpha, x[j] / (x[j] - z[j]));
    }
    if (alpha >= 1.0) return z;
    x += alpha * (z - x);
    for (std::size_t i = 0; i < passive.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      if (passive[i] && (x[j] <= 1e-15 * x.maxCoeff() || x[j] <= 0.0)) {
        passive[i] = false;
        x[j] = 0.0;
      }
    }
  }
  return Eigen::VectorXd::Zero(A.cols());
}

}  // namespace

NonnegativeSolution nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  require(A.rows() == b.size() && A.cols() > 0 && A.allFinite() && b.allFinite(),
          "nonnegative_least_squares: A and b must fit and be finite");
  // No tolerance tells a small gradient from none: a column that is nearly a passive one, as of contacts side by side,
  // has a small gradient however large the residual is. Whether its entering gains anything is tried out.
  const double done = 1e-15 * b.norm();
  NonnegativeSolution solution{Eigen::VectorXd::Zero(A.cols()), b.norm(), false};
  std::vector<bool> passive(static_cast<std::size_t>(A.cols()), false);
  std::vector<bool> useless = passive;  // columns whose entering gained nothing since the last gain
  for (Eigen::Index step = 0; step < 10 * A.cols(); ++step) {
    const Eigen::VectorXd gradient = A.transpose() * (b - A * solution.x);
    Eigen::Index enter = -1;
    for (Eigen::Index j = 0; j < A.cols() && solution.residual > done; ++j) {
      const auto i = static_cast<std::size_t>(j);
      if (passive[i] || useless[i] || gradient[j] <= 0.0) continue;
      if (enter < 0 || gradient[j] > gradient[enter]) enter = j;
    }
    if (enter < 0) {
      solution.converged = true;
      break;
    }
    std::vector<bool> wider = passive;
    wider[static_cast<std::size_t>(enter)] = true;
    const Eigen::VectorXd x = feasible_solution(A, b, solution.x, wider);
    const double residual = (A * x - b).norm();
    if (residual >= solution.residual) {  // rounding
      useless[static_cast<std::size_t>(enter)] = true;
      continue;
    }
    std::fill(useless.begin(), useless.end(), false);
    solution.x = x;
    solution.residual = residual;
    passive = wider;
  }
  return solution;
}

}  // namespace opponens::verify
