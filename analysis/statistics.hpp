// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/synergies.hpp"

namespace opponens::analysis {

using RowMajorSamples = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Mean and covariance of rows, each of the given weight, in one pass over memory: leaves of 4096 rows, centred near
/// their own mean (so a large mean costs no digits), merged pairwise in a fixed order. The covariance is the
/// maximum-likelihood one (divisor: the sum of the weights), as merge() and Eq. (1) need it. The same bits on every
/// processor (analysis/moment_kernel.hpp) and with any number of threads. q: [T x n] rad, row = sample, T >= 1, finite,
/// and small enough to be squared. weight > 0. Cost O(T n^2).
SampleStatistics moments(const Eigen::Ref<const Eigen::MatrixXd>& q, double weight = 1.0, int threads = 1);

/// The same, to the bit, of samples stored row by row.
SampleStatistics moments_of_rows(const Eigen::Ref<const RowMajorSamples>& q, double weight = 1.0, int threads = 1);

/// Moments of the union of two sets from theirs, exact up to rounding (Chan, Golub and LeVeque 1983,
/// doi:10.1080/00031305.1983.10483115). An empty side (count 0) returns the other.
SampleStatistics merge(const SampleStatistics& a, const SampleStatistics& b);

/// Sets that arrive one after the other, merged pairwise like a balanced tree: rounding grows with the logarithm of
/// their number, and so does the memory. The tree depends on their number and order alone.
class PairwiseMerge {
 public:
  void add(SampleStatistics part);
  /// Of all sets added so far; an empty one (count 0) when there are none.
  SampleStatistics result() const;

 private:
  std::vector<SampleStatistics> open_;  // complete subtrees, the largest first
  std::uint64_t added_ = 0;
};

/// Moments of the union of several sets, merged pairwise in the given order. At least one set.
SampleStatistics pooled(const std::vector<SampleStatistics>& parts);

/// The same set in x = q ./ scale. scale: [n] > 0.
SampleStatistics scaled(const SampleStatistics& statistics, const Eigen::VectorXd& scale);

}  // namespace opponens::analysis
