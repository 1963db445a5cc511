// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace opponens {

/// Moments of a set of hand configurations, n joints.
struct SampleStatistics {
  double count = 0.0;          ///< number of samples, or the sum of their weights
  Eigen::VectorXd mean;        ///< [n] rad
  Eigen::MatrixXd covariance;  ///< [n x n] rad^2, symmetric, positive semidefinite
};

/// Principal axes of a set of hand configurations: the paper's synergies (section 4.1).
struct SynergyBasis {
  Eigen::VectorXd mean;  ///< [n] scaled joint units
  Eigen::MatrixXd axes;  ///< [n x n] orthonormal columns = synergies; the largest-magnitude entry of each is positive
  Eigen::VectorXd variance;  ///< [n] descending, >= 0
  double count = 0.0;        ///< samples behind it
};

/// The box of section 4.1 around the first k synergies: { center + axes y : |y_i| <= half_width_i }, in scaled space
/// x = q ./ scale.
struct SynergyBox {
  Eigen::VectorXd center;      ///< [n] scaled
  Eigen::MatrixXd axes;        ///< [n x k] orthonormal columns
  Eigen::VectorXd half_width;  ///< [k] scaled, >= 0
  Eigen::VectorXd scale;       ///< [n] rad per scaled unit; ones = radians
  double alpha = 0.05;         ///< fraction of the configurations left outside the full n-box
  double beta = 0.05;          ///< fraction of the variance left out by keeping k synergies
};

/// The synergies of one phase and group, and how they came about.
struct SynergyGroup {
  std::string name;   ///< group name; "pre-grasp" for the common first phase
  std::string phase;  ///< "pre-grasp", "grasp" or "all"
  SynergyBasis basis;
  SynergyBox box;                             ///< the first k synergies
  int dof_effective = 0;                      ///< dimension of the subspace the samples span
  std::vector<std::string> dropped_channels;  ///< constant or linearly dependent joints
};

struct SynergySet {
  std::vector<std::string> joint_names;  ///< [n]
  SynergyGroup pre_grasp;
  std::vector<SynergyGroup> grasp;  ///< one per group, sorted by name
  int order = 0;  ///< 0: of joint positions; 1: first-order synergies, of joint velocities (per second)
};

}  // namespace opponens
