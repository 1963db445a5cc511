// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// min 1'b subject to A b = c, b >= 0 with A [6 x N]: the revised simplex method with the inverse of the 6 x 6 basis
/// (largest coefficient; Bland's rule while degenerate). Rounding of ill-conditioned bases can leave a basic value
/// negative: a few pivots of the dual simplex method mend that at the optimum. Cost: O(6 N) per pivot, about 15 pivots.
/// A and c are best of unit scale and must outlive this.
class SixRowSimplex {
 public:
  SixRowSimplex(const Matrix6Xd& a, const Vector6d& c);

  /// Drives the artificial columns to zero; false when they cannot be (then dual() is a Farkas certificate: y'A <= 0,
  /// y'c > 0), nullopt when the pivot limit was met.
  std::optional<bool> feasible();
  /// After feasible(): false when the pivot limit was met.
  bool optimize();

  const std::array<int, 6>& basis() const { return basis_; }  ///< columns of A; < 0: artificial column -1 - row
  const Vector6d& value() const { return value_; }            ///< of the basis
  const Vector6d& dual() const { return dual_; }              ///< y: at the optimum y'A <= 1, y'c = 1'b

 private:
  Vector6d column(int j) const;
  void refactor();
  int entering(double cost, bool bland) const;
  int leaving(const Vector6d& direction, bool phase_two) const;
  bool minimize(double cost, double artificial_cost);
  int infeasible_row() const;
  int entering_for(int row) const;
  bool mend();
  void pivot(int leave, int enter, const Vector6d& direction);

  const Matrix6Xd& a_;
  const Vector6d& c_;
  std::array<int, 6> basis_;
  Vector6d sign_;
  Eigen::Matrix<double, 6, 6> inverse_;
  Vector6d value_;
  Vector6d dual_;
  int since_refactor_ = 0;
};

}  // namespace opponens::grasp
