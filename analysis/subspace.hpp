// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace opponens::analysis {

/// Channels that span the samples, and those that add nothing to them (docs/deviations.md, 2).
struct EffectiveSubspace {
  std::vector<int> kept;     ///< ascending channel indices; their count is the effective number of degrees of freedom
  std::vector<int> dropped;  ///< ascending: constant channels and linear combinations of the kept ones
  int dof() const { return static_cast<int>(kept.size()); }
};

/// Finds the channels that span the samples by a Cholesky factorisation of the covariance with diagonal pivoting
/// (Higham 2002, Accuracy and Stability of Numerical Algorithms, section 10.3), in units of the sensor resolution r:
/// the channel with the largest remaining variance is taken next, until every channel left has a standard deviation,
/// given the taken ones, of at most r. An exact combination c = a - b of channels rounded to r leaves three rounding
/// errors of variance r^2/12, a standard deviation of r/2; the factor two is the margin for a sample's scatter. A
/// channel is also dropped when rounding alone explains what remains: less than 1e-12 of its own variance, or 1e-20 of
/// the largest one (a constant 0.3 has a computed variance of 1e-33). With r = 0 these are the only rules.
/// covariance: [n x n]. resolution: [n] >= 0, same unit as the channels. Cost O(n^3).
EffectiveSubspace effective_subspace(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                     const Eigen::Ref<const Eigen::VectorXd>& resolution);

/// Names of the channels at the given indices.
std::vector<std::string> names_at(const std::vector<std::string>& names, const std::vector<int>& indices);

}  // namespace opponens::analysis
