// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// At most six linearly independent columns of W whose cone holds v.
struct ConicBasis {
  std::vector<int> columns;
  Eigen::VectorXd weights;  ///< >= 0: v is the weighted sum of the columns
};

/// Non-negative least squares min |W a - v|, a >= 0 in doubles (Lawson and Hanson 1974, chapter 23). W is [6 x N], of
/// about unit size. nullopt when the residual stays above 1e-10 (|v| + sum a), or after 200 steps: v lies outside the
/// cone of the columns as far as doubles tell. Cost: 12 N flops and a least squares problem of six rows a step, about
/// ten steps.
std::optional<ConicBasis> conic_basis(const Matrix6Xd& wrenches, const Vector6d& v);

}  // namespace opponens::grasp
