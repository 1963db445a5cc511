// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/six_row_simplex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace opponens::grasp {
namespace {

constexpr int kMaxPivots = 2000;
constexpr int kRefactor = 24;           // pivots between two fresh inverses of the basis
constexpr double kReducedCost = 1e-11;  // a column enters when it gains more than this
constexpr double kPivot = 1e-11;        // least pivot element, relative to the entering column
constexpr double kZero = 1e-13;         // basic values below this are degenerate
constexpr int kPatience = 6;            // degenerate pivots in a row before Bland's rule

}  // namespace

SixRowSimplex::SixRowSimplex(const Matrix6Xd& a, const Vector6d& c) : a_(a), c_(c) {
  for (int row = 0; row < 6; ++row) {
    basis_[row] = -1 - row;
    sign_[row] = c_[row] < 0.0 ? -1.0 : 1.0;
  }
  refactor();
}

std::optional<bool> SixRowSimplex::feasible() {
  if (!minimize(0.0, 1.0)) return std::nullopt;
  double left = 0.0;
  for (int row = 0; row < 6; ++row) left += basis_[row] < 0 ? std::abs(value_[row]) : 0.0;
  return left <= 1e-9;
}

bool SixRowSimplex::optimize() { return minimize(1.0, 0.0); }

Vector6d SixRowSimplex::column(int j) const {
  return j >= 0 ? Vector6d(a_.col(j)) : Vector6d(sign_[-1 - j] * Vector6d::Unit(-1 - j));
}

void SixRowSimplex::refactor() {
  Eigen::Matrix<double, 6, 6> b;
  for (int row = 0; row < 6; ++row) b.col(row) = column(basis_[row]);
  inverse_ = b.partialPivLu().inverse();
  value_ = inverse_ * c_;
  since_refactor_ = 0;
}

/// Index of the column to enter, or -1 at the optimum.
int SixRowSimplex::entering(double cost, bool bland) const {
  const double* w = a_.data();
  int best = -1;
  double gain = kReducedCost;
  for (Eigen::Index j = 0; j < a_.cols(); ++j, w += 6) {
    const double product =
        (dual_[0] * w[0] + dual_[1] * w[1] + dual_[2] * w[2]) + (dual_[3] * w[3] + dual_[4] * w[4] + dual_[5] * w[5]);
    if (product - cost > gain) {
      best = static_cast<int>(j);
      if (bland) return best;
      gain = product - cost;
    }
  }
  return best;
}

/// Row whose basic variable leaves, or -1 when nothing stops the entering one. A spent artificial (phase 2) leaves at
/// once, whatever the sign of its pivot, so that it stays zero.
int SixRowSimplex::leaving(const Vector6d& direction, bool phase_two) const {
  const double least = kPivot * direction.cwiseAbs().maxCoeff();
  int best = -1;
  double best_ratio = std::numeric_limits<double>::infinity();
  for (int row = 0; row < 6; ++row) {
    const bool spent = phase_two && basis_[row] < 0;
    if (spent ? std::abs(direction[row]) <= 1e-9 * direction.cwiseAbs().maxCoeff() : direction[row] <= least) continue;
    const double ratio = spent ? 0.0 : std::max(value_[row], 0.0) / direction[row];
    if (best < 0 || ratio < best_ratio || (ratio == best_ratio && basis_[row] < basis_[best])) {
      best = row;
      best_ratio = ratio;
    }
  }
  return best;
}

bool SixRowSimplex::minimize(double cost, double artificial_cost) {
  int degenerate = 0;
  for (int pivots = 0; pivots < kMaxPivots; ++pivots) {
    Vector6d basic_cost;
    for (int row = 0; row < 6; ++row) basic_cost[row] = basis_[row] < 0 ? artificial_cost : cost;
    dual_ = inverse_.transpose() * basic_cost;
    const int enter = entering(cost, degenerate > kPatience);
    if (enter < 0) {
      if (since_refactor_ == 0) return true;
      refactor();  // confirm the optimum with a fresh inverse
      continue;
    }
    const Vector6d direction = inverse_ * a_.col(enter);
    const int leave = leaving(direction, artificial_cost == 0.0);
    if (leave < 0) return false;  // both objectives are bounded below: only rounding leads here
    const double step = value_[leave] / direction[leave];
    degenerate = step <= kZero ? degenerate + 1 : 0;
    basis_[leave] = enter;
    if (++since_refactor_ >= kRefactor) {
      refactor();
      continue;
    }
    const Eigen::Matrix<double, 1, 6> pivot_row = inverse_.row(leave) / direction[leave];
    inverse_ -= direction * pivot_row;
    inverse_.row(leave) = pivot_row;
    value_ -= step * direction;
    value_[leave] = step;
  }
  return false;
}

}  // namespace opponens::grasp
