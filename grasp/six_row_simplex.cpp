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
constexpr double kNegative = 1e-12;     // basic values below minus this are not feasible
constexpr int kMends = 50;              // dual pivots in a row
constexpr int kMaxMends = 4;            // times that a mended basis may need primal pivots again
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

bool SixRowSimplex::optimize() {
  for (int round = 0; round < kMaxMends; ++round) {
    if (!minimize(1.0, 0.0)) return false;
    if (infeasible_row() < 0) return true;
    if (!mend()) return false;
  }
  return false;
}

Vector6d SixRowSimplex::column(int j) const {
  return j >= 0 ? Vector6d(a_.col(j)) : Vector6d(sign_[-1 - j] * Vector6d::Unit(-1 - j));
}

void SixRowSimplex::refactor() {
  Eigen::Matrix<double, 6, 6> b;
  for (int row = 0; row < 6; ++row) b.col(row) = column(basis_[row]);
  inverse_ = b.partialPivLu().inverse();
  value_ = inverse_ * c_;
  value_ += inverse_ * (c_ - b * value_);  // one step of refinement: ill-conditioned bases lose digits
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
    pivot(leave, enter, direction);
  }
  return false;
}

/// The column `enter` takes the place of the basis's row `leave`; direction: the column in terms of the basis.
void SixRowSimplex::pivot(int leave, int enter, const Vector6d& direction) {
  const double step = value_[leave] / direction[leave];
  basis_[leave] = enter;
  if (++since_refactor_ >= kRefactor) return refactor();
  const Eigen::Matrix<double, 1, 6> pivot_row = inverse_.row(leave) / direction[leave];
  inverse_ -= direction * pivot_row;
  inverse_.row(leave) = pivot_row;
  value_ -= step * direction;
  value_[leave] = step;
}

/// The row that is least feasible: negative, or a spent artificial that is not zero; -1: none is.
int SixRowSimplex::infeasible_row() const {
  int worst = -1;
  double excess = kNegative;
  for (int row = 0; row < 6; ++row) {
    const double here = basis_[row] < 0 ? std::abs(value_[row]) : -value_[row];
    if (here <= excess) continue;
    worst = row;
    excess = here;
  }
  return worst;
}

/// Column that makes this row feasible and keeps the dual so (least ratio of the dual simplex method); -1: none does.
int SixRowSimplex::entering_for(int row) const {
  const double sign = value_[row] < 0.0 ? -1.0 : 1.0;
  const Eigen::VectorXd alpha = sign * (inverse_.row(row) * a_).transpose();
  const double least = 1e-9 * alpha.cwiseAbs().maxCoeff();
  int best = -1;
  double best_ratio = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < a_.cols(); ++j) {
    if (alpha[j] <= least || std::find(basis_.begin(), basis_.end(), j) != basis_.end()) continue;
    const double ratio = std::max(1.0 - dual_.dot(a_.col(j)), 0.0) / alpha[j];
    if (ratio >= best_ratio) continue;
    best = static_cast<int>(j);
    best_ratio = ratio;
  }
  return best;
}

/// Pivots of the dual simplex method from an optimal basis until its values are feasible.
bool SixRowSimplex::mend() {
  for (int pivots = 0; pivots < kMends; ++pivots) {
    const int leave = infeasible_row();
    if (leave < 0) return true;
    const int enter = entering_for(leave);
    if (enter < 0) return false;
    pivot(leave, enter, inverse_ * a_.col(enter));
    Vector6d basic_cost;
    for (int row = 0; row < 6; ++row) basic_cost[row] = basis_[row] < 0 ? 0.0 : 1.0;
    dual_ = inverse_.transpose() * basic_cost;
  }
  return false;
}

}  // namespace opponens::grasp
