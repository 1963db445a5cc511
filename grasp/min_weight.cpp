// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/min_weight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/require.hpp"
#include "grasp/six_row_simplex.hpp"

namespace opponens::grasp {
namespace {

constexpr double kBoundary = 1e-13;  // N l* below this is rounding

}  // namespace

MinWeight min_weight(const Matrix6Xd& wrenches) {
  require(wrenches.allFinite(), "min_weight: wrenches must be finite");
  MinWeight solution;
  if (wrenches.cols() == 0) return solution;
  const double count = static_cast<double>(wrenches.cols());
  const double scale = wrenches.colwise().norm().maxCoeff();
  // Unit scale inside: l* does not change when all wrenches are multiplied by one positive number.
  const double unit = scale > 0.0 ? 1.0 / scale : 1.0;
  const Vector6d mean = unit * wrenches.rowwise().mean();
  const Matrix6Xd a = (-unit * wrenches).colwise() + mean;
  SixRowSimplex simplex(a, mean);
  const std::optional<bool> feasible = simplex.feasible();
  if (!feasible) solution.state = MinWeight::State::not_converged;
  if (!feasible.value_or(false)) return solution;
  const bool done = simplex.optimize();
  solution.state = done ? MinWeight::State::optimal : MinWeight::State::not_converged;
  double sum = 0.0;
  solution.weights = Eigen::VectorXd::Zero(wrenches.cols());
  for (int row = 0; row < 6; ++row) {
    if (simplex.basis()[row] < 0) continue;
    const double b = std::max(simplex.value()[row], 0.0);
    solution.weights[simplex.basis()[row]] = b;
    sum += b;
  }
  solution.value = std::abs(1.0 - sum) < kBoundary ? 0.0 : (1.0 - sum) / count;
  solution.weights.array() += solution.value;
  solution.dual = simplex.dual() * (unit / count);
  return solution;
}

Matrix6Xd min_weight_gradient(const MinWeight& solution) { return -solution.dual * solution.weights.transpose(); }

}  // namespace opponens::grasp
