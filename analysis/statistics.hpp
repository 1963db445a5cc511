// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/synergies.hpp"

namespace opponens::analysis {

/// Mean and covariance of rows, each of the given weight. Two passes: centred, so a large mean costs no digits. The
/// covariance is the maximum-likelihood one (divisor: the sum of the weights), as merge() and Eq. (1) need it.
/// q: [T x n] rad, row = sample, T >= 1. weight > 0. Cost O(T n^2).
SampleStatistics moments(const Eigen::Ref<const Eigen::MatrixXd>& q, double weight = 1.0);

/// Moments of the union of two sets from theirs, exact up to rounding (Chan, Golub and LeVeque 1983,
/// doi:10.1080/00031305.1983.10483115). An empty side (count 0) returns the other.
SampleStatistics merge(const SampleStatistics& a, const SampleStatistics& b);

/// Moments of the union of several sets, merged in the given order. At least one set.
SampleStatistics pooled(const std::vector<SampleStatistics>& parts);

/// The same set in x = q ./ scale. scale: [n] > 0.
SampleStatistics scaled(const SampleStatistics& statistics, const Eigen::VectorXd& scale);

}  // namespace opponens::analysis
