// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/min_weight.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

#include "core/require.hpp"

namespace opponens::grasp {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMaxPivots = 2000;
constexpr int kRefactor = 24;           // pivots between two fresh inverses of the basis
constexpr double kReducedCost = 1e-11;  // a column enters when it gains more than this
constexpr double kPivot = 1e-11;        // least pivot element, relative to the entering column
constexpr double kZero = 1e-13;         // basic values below this are degenerate, relative to the scale
constexpr double kBoundary = 1e-13;     // N l* below this is rounding
constexpr int kPatience = 6;            // degenerate pivots in a row before Bland's rule

/// min cost'b subject to A b = c, b >= 0 with A [6 x N]. Basic entries < 0 name artificial columns: -1 - row.
class Simplex {
 public:
  Simplex(const Matrix6Xd& a, const Vector6d& c, double scale) : a_(a), c_(c), scale_(scale) {
    for (int row = 0; row < 6; ++row) {
      basis_[row] = -1 - row;
      sign_[row] = c_[row] < 0.0 ? -1.0 : 1.0;
    }
    refactor();
  }

  /// Drives the artificial columns to zero; false when they cannot be, nullopt when the pivot limit was met.
  std::optional<bool> feasible() {
    if (!minimize(0.0, 1.0)) return std::nullopt;
    double left = 0.0;
    for (int row = 0; row < 6; ++row) left += basis_[row] < 0 ? std::abs(value_[row]) : 0.0;
    return left <= 1e-9 * scale_;
  }
  bool optimize() { return minimize(1.0, 0.0); }

  const std::array<int, 6>& basis() const { return basis_; }
  const Vector6d& value() const { return value_; }
  const Vector6d& dual() const { return dual_; }

 private:
  Vector6d column(int j) const {
    return j >= 0 ? Vector6d(a_.col(j)) : Vector6d(sign_[-1 - j] * Vector6d::Unit(-1 - j));
  }

  void refactor() {
    Matrix6d b;
    for (int row = 0; row < 6; ++row) b.col(row) = column(basis_[row]);
    inverse_ = b.partialPivLu().inverse();
    value_ = inverse_ * c_;
    since_refactor_ = 0;
  }

  /// Index of the column to enter, or -1 at the optimum.
  int entering(double cost, bool bland) const {
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
  int leaving(const Vector6d& direction, bool phase_two) const {
    const double least = kPivot * direction.cwiseAbs().maxCoeff();
    int best = -1;
    double best_ratio = std::numeric_limits<double>::infinity();
    for (int row = 0; row < 6; ++row) {
      const bool spent = phase_two && basis_[row] < 0;
      if (spent ? std::abs(direction[row]) <= 1e-9 * direction.cwiseAbs().maxCoeff() : direction[row] <= least)
        continue;
      const double ratio = spent ? 0.0 : std::max(value_[row], 0.0) / direction[row];
      if (best < 0 || ratio < best_ratio || (ratio == best_ratio && basis_[row] < basis_[best])) {
        best = row;
        best_ratio = ratio;
      }
    }
    return best;
  }

  bool minimize(double cost, double artificial_cost) {
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
      degenerate = step <= kZero * scale_ ? degenerate + 1 : 0;
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

  const Matrix6Xd& a_;
  const Vector6d& c_;
  double scale_;
  std::array<int, 6> basis_;
  Vector6d sign_;
  Matrix6d inverse_;
  Vector6d value_;
  Vector6d dual_;
  int since_refactor_ = 0;
};

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
  Simplex simplex(a, mean, 1.0);
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
