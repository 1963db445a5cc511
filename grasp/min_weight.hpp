// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// Min-weight metric of N wrenches W [6 x N] (FRoGGeR: Li et al. 2024, doi:10.1109/ICRA57147.2024.10610519):
///   l* = max l subject to W a = 0, 1'a = 1, a >= l.
/// l* > 0 exactly when the origin is in the relative interior of the hull; l* <= 1/N.
struct MinWeight {
  enum class State {
    optimal,
    no_balance,     ///< W a = 0, 1'a = 1 has no solution: the origin is outside the affine hull of the wrenches
    not_converged,  ///< the pivot limit was met (rounding); value is a lower bound where weights are given
  };
  State state = State::no_balance;
  /// l*; exactly 0 when N |l*| < 1e-13: two contacts that pinch, and others that add nothing, put the origin on the
  /// boundary of the hull, so this is no rare case.
  double value = 0.0;
  Eigen::VectorXd weights;           ///< [N] a
  Vector6d dual = Vector6d::Zero();  ///< y: multiplier of W a = 0
};

/// With c the mean wrench and b = a - l: 1 - N l* = min 1'b subject to sum_j b_j (c - w_j) = c, b >= 0: a linear
/// programme of six rows, solved by the revised simplex method (largest coefficient, Bland's rule while degenerate).
/// Cost: O(6 N) per pivot, about 15 pivots. Where the optimum is not
/// unique (four cone edges in one plane have several balances) the gradient below is that of one of them.
MinWeight min_weight(const Matrix6Xd& wrenches);

/// d l* / d W [6 x N] = -y a'.
Matrix6Xd min_weight_gradient(const MinWeight& solution);

}  // namespace opponens::grasp
