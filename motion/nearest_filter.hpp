// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace opponens::motion {

/// A copy of a forest's vertices in single precision, scaled by the metric, that tells which of them can be the nearest
/// to a configuration. What it leaves out is further away for certain: with u = 2^-24, a squared distance f found in
/// single precision of d joints of size <= M obeys |sqrt(f) - D| <= (d / 2 + 2) u D + 2 sqrt(d) u M to first order, so
/// the nearest vertex lies within the least sqrt(f) (1 + 4 (d + 8) u) + 8 sqrt(d) u M. Which instructions the processor
/// has does not show: who asks decides among what is left in double precision.
class NearestFilter {
 public:
  /// weights: [d] of the joint metric.
  explicit NearestFilter(const Eigen::VectorXd& weights);

  void add(const double* q);  ///< [d] rad, the next vertex
  void clear();

  static constexpr int kBlock = 16;  ///< vertices are told in blocks of so many
  /// Ascending numbers of the blocks (vertices kBlock i to kBlock i + 15) that can hold the nearest. q: [d] rad.
  std::vector<int> candidates(const double* q) const;

 private:
  int dimension_;
  int size_ = 0;
  double largest_ = 0.0;                    ///< of the scaled coordinates' magnitudes
  std::vector<double> scale_;               ///< [d] square roots of the weights
  std::vector<std::vector<float>> groups_;  ///< as of filter::Blocks
};

}  // namespace opponens::motion
