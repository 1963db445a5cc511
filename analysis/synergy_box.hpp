// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/synergies.hpp"

namespace opponens::analysis {

/// Which root of 1 - alpha sizes a box of n independent axes so that it holds 1 - alpha of a normal distribution.
enum class BoxRoot {
  n,        ///< (1 - alpha)^(1/n): keeps the promise (docs/deviations.md)
  k,        ///< (1 - alpha)^(1/k): the promise for the k kept coordinates only
  literal,  ///< sqrt(1 - alpha): as printed in the paper; right for n = 2 only
};

/// Half width of a box along each axis: sqrt(2) erf^-1(root) * standard deviation. variance: [m], n: dof_effective.
Eigen::VectorXd box_half_width(const Eigen::VectorXd& variance, double alpha, BoxRoot root, int n, int k);

/// Smallest k whose cumulative variance share is >= 1 - beta; at least 1.
int synergies_needed(const Eigen::VectorXd& variance, double beta);

/// The box of the first k = synergies_needed(variance, beta) synergies of a basis found in x = q ./ scale.
/// dof_effective: n of the root. scale: [n] rad per scaled unit.
SynergyBox make_box(const SynergyBasis& basis, const Eigen::VectorXd& scale, double alpha, double beta, BoxRoot root,
                    int dof_effective);

/// The box of several hands at once, their joints one after another: the configurations whose every part lies in its
/// own box. Axes are block-diagonal, so PROJECT is that of each hand alone. At least one box. alpha: of hands that move
/// independently; beta: the largest, since a box does not tell the variance that it is a share of.
SynergyBox product_box(const std::vector<SynergyBox>& boxes);

/// Probability that one standard normal coordinate lies inside the half width: the root itself.
double axis_probability(double alpha, BoxRoot root, int n, int k);

/// Synergy coordinates y = axes' (q ./ scale - center), [k] scaled units. q: [n] rad.
Eigen::VectorXd coordinates(const SynergyBox& box, const Eigen::VectorXd& q);

/// q = scale .* (center + axes y), [n] rad. y: [k].
Eigen::VectorXd configuration(const SynergyBox& box, const Eigen::VectorXd& y);

/// PROJECT of Algorithm 3: the point of the box nearest to q in scaled space (coordinates clamped, zero beyond k).
/// Idempotent. The result may stick out of joint limits; the caller clips.
Eigen::VectorXd project(const SynergyBox& box, const Eigen::VectorXd& q);

/// Whether the first k coordinates of q lie in the box, with a tolerance in scaled units.
bool contains(const SynergyBox& box, const Eigen::VectorXd& q, double tolerance = 1e-9);

}  // namespace opponens::analysis
