// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/synergies.hpp"

namespace opponens::analysis {

/// Principal axes (synergies, paper section 4.1) of a set from its covariance, by a symmetric eigen-decomposition,
/// O(n^3). Sign convention: the largest-magnitude entry of an axis is positive (the first of equals). Variances are
/// descending; rounding below zero is set to zero. No ridge is added. The unit is that of the statistics: pass
/// scaled(statistics, scale) for another space than radians. Equal variances leave their axes free within their plane.
SynergyBasis principal_axes(const SampleStatistics& statistics);

/// Share of the total variance in the first i + 1 axes, [n], ascending to 1. Nothing varies: all ones.
Eigen::VectorXd cumulative_variance(const Eigen::VectorXd& variance);

}  // namespace opponens::analysis
