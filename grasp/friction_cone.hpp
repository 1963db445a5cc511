// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// The wrenches of one contact under the exact friction cone, w(e) = (c + mu (e_x x + e_y y + e_z z)) / s over the
/// edges e_x^2 + e_y^2 <= 1 (point with friction), e_x^2 + e_y^2 + (e_z / torsion_radius)^2 <= 1 (soft finger), e = 0
/// (frictionless); s = 1 or, under the unit force, the length of the contact's force (a point contact with friction
/// then has the rim e_x^2 + e_y^2 = 1 alone, as pyramids have).
struct QuadraticContact {
  QuadraticContact(const Contact& contact, const QualityConvention& convention);

  /// A wrench of the contact that is extreme in direction u, in closed form but for a soft finger under the unit force:
  /// there the extreme latitude is the root of a strictly decreasing function, found by Newton's method in a bracket.
  Vector6d support(const Vector6d& u) const;
  double scale() const;  ///< an upper bound of the length of its wrenches

 private:
  Vector6d center_;                   // c: a unit force along the normal
  Eigen::Matrix<double, 6, 3> axes_;  // x, y: unit forces along the tangents; z: a unit torque about the normal
  double mu_;
  double torsion_radius_;  // m; zero: no torque
  bool friction_;
  bool unit_force_;
};

}  // namespace opponens::grasp
