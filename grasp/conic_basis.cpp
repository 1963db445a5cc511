// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/conic_basis.hpp"

#include <algorithm>

#include <Eigen/QR>

namespace opponens::grasp {
namespace {

constexpr int kMaxEntries = 200;
constexpr double kResidual = 1e-10;  // relative to |v| + sum a: v is reached
constexpr double kNoGain = 1e-13;    // slope of the residual below which a column does not enter
constexpr double kNothing = 1e-15;   // weights below this share of the largest are zero

using SixColumns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using SixWeights = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

class ConeSupport {
 public:
  ConeSupport(const Matrix6Xd& wrenches, const Vector6d& v) : wrenches_(wrenches), v_(v), residual_(v) {}

  /// The column that lessens the residual most, or -1.
  int entering() const {
    Eigen::Index best = -1;
    const double gain = wrenches_.cols() == 0 ? 0.0 : (residual_.transpose() * wrenches_).maxCoeff(&best);
    if (gain <= kNoGain * residual_.norm()) return -1;
    const bool inside = std::find(columns_.begin(), columns_.end(), static_cast<int>(best)) != columns_.end();
    return inside ? -1 : static_cast<int>(best);  // rounding: it cannot gain any more
  }

  /// Takes a column in and moves to the least squares solution, dropping columns that would turn negative on the way.
  void add(int column) {
    columns_.push_back(column);
    weights_.conservativeResize(static_cast<Eigen::Index>(columns_.size()));
    weights_[weights_.size() - 1] = 0.0;
    while (!columns_.empty()) {
      const SixWeights target = least_squares();
      double step = 1.0;
      for (Eigen::Index i = 0; i < target.size(); ++i) {
        if (target[i] <= 0.0) step = std::min(step, weights_[i] / std::max(weights_[i] - target[i], 1e-300));
      }
      weights_ += step * (target - weights_);
      if (step >= 1.0) break;
      drop_zeros();
    }
    residual_ = v_ - chosen() * weights_;
  }

  bool reached() const { return residual_.norm() <= kResidual * (v_.norm() + weights_.sum()); }
  bool full() const { return columns_.size() == 6; }
  double residual() const { return residual_.norm(); }
  ConicBasis basis() const { return {columns_, weights_}; }

 private:
  SixColumns chosen() const { return wrenches_(Eigen::all, columns_); }
  SixWeights least_squares() const { return chosen().colPivHouseholderQr().solve(v_); }

  void drop_zeros() {
    const double zero = kNothing * weights_.maxCoeff();
    Eigen::Index kept = 0;
    for (Eigen::Index i = 0; i < weights_.size(); ++i) {
      if (weights_[i] <= zero) continue;
      weights_[kept] = weights_[i];
      columns_[static_cast<std::size_t>(kept++)] = columns_[static_cast<std::size_t>(i)];
    }
    weights_.conservativeResize(kept);
    columns_.resize(static_cast<std::size_t>(kept));
  }

  const Matrix6Xd& wrenches_;
  const Vector6d& v_;
  std::vector<int> columns_{};
  SixWeights weights_{};
  Vector6d residual_;
};

}  // namespace

std::optional<ConicBasis> conic_basis(const Matrix6Xd& wrenches, const Vector6d& v) {
  ConeSupport set(wrenches, v);
  for (int step = 0; step < kMaxEntries && !set.full(); ++step) {
    const int column = set.entering();
    if (column < 0) break;
    const double before = set.residual();
    set.add(column);
    if (set.residual() >= before) break;  // rounding: nothing is gained any more
  }
  if (!set.reached()) return std::nullopt;
  return set.basis();
}

}  // namespace opponens::grasp
