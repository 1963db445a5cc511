// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/result.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

/// Principal angles between the spans of a [n x k] and b [n x l], both with orthonormal columns: min(k, l) angles in
/// [0, pi/2] rad, ascending. Cosines are singular values of a'b; below pi/4, where a cosine says little, sines are
/// taken from (I - aa')b instead (Bjorck and Golub 1973, doi:10.2307/2005662), so angles are right to rounding
/// everywhere. Throws std::invalid_argument for columns that are not orthonormal to 1e-8 or for different n.
Eigen::VectorXd principal_angles(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                 const Eigen::Ref<const Eigen::MatrixXd>& b);

/// Geodesic distance sqrt(sum of angle^2) in rad of two subspaces of the same dimension; each dimension that one has
/// more than the other counts as a right angle (Ye and Lim 2016, doi:10.1137/15M1054201).
double subspace_distance(const Eigen::VectorXd& angles, int k_a, int k_b);

/// How far two groups of synergies are apart. Everything is about joint angles in radians (or rad/s), whatever the
/// scale that either was learnt in; the angles are those between the spans of the kept synergies.
struct SynergyComparison {
  std::string group;
  int k_a = 0;
  int k_b = 0;
  Eigen::VectorXd angles;  ///< [min(k_a, k_b)] rad
  double distance = 0.0;   ///< rad, subspace_distance
  double shared_a = 0.0;   ///< share of a's variance that lies in the span of b's kept synergies, in [0, 1]
  double shared_b = 0.0;   ///< share of b's variance in the span of a's
  std::optional<double> bhattacharyya;  ///< distance of the two normal distributions, >= 0
  std::optional<double> log_likeness;   ///< Eq. (1) of the two
};

/// Compares two groups over the same joints. resolution: of the sensors, rad; its square is the ridge of the last two,
/// which are left out without it. Fails (invalid_input) when the joints' numbers differ, (degenerate) when a covariance
/// is singular without a ridge.
Result<SynergyComparison> compare(const SynergyGroup& a, const SynergyGroup& b, std::optional<double> resolution);

/// Compares the groups that both sets have (by name; the pre-grasp first). Of velocities (order 1) without the last
/// two: what the resolution in rad makes of them depends on the sampling, which a set does not tell. Fails when the
/// sets are of different joints, of different order, or have no group in common.
Result<std::vector<SynergyComparison>> compare(const SynergySet& a, const SynergySet& b, double resolution);

}  // namespace opponens::analysis
