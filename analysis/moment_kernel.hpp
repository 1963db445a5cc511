// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/synergies.hpp"

namespace opponens::analysis {

/// Vector instructions the kernel may use. Every level computes the same eight partial sums in the same order without
/// fused multiply-adds, so all give the same bits (tests/analysis/moment_kernel_test.cpp).
enum class SimdLevel { baseline, avx2, avx512 };

/// The levels that this processor has, ascending; at least the baseline.
std::vector<SimdLevel> simd_levels();

/// Samples in memory: value (i, j) is data[i * row_stride + j * column_stride].
struct SampleView {
  const double* data;
  Eigen::Index rows;
  Eigen::Index columns;
  Eigen::Index row_stride;
  Eigen::Index column_stride;
};

/// Rows to which one leaf of the merge tree belongs: their partial sums stay in the first-level cache.
inline constexpr Eigen::Index kLeafRows = 4096;

/// Moments of at most kLeafRows rows, each of weight 1, in one pass over memory. Sums are taken of x - s with s the
/// mean of the first 64 rows (itself summed relative to the first row, so a constant column has the variance 0
/// exactly): what the square of the remaining mean costs is at most a factor of kLeafRows / 64 on rounding, whatever
/// the values. Result not finite when a value is not, or when squares overflow. O(rows columns^2).
SampleStatistics leaf_moments(const SampleView& samples, const Eigen::VectorXd& origin, SimdLevel level);

}  // namespace opponens::analysis
