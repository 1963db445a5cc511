// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"

namespace opponens::grasp {

/// Primitive contact wrenches [6 x (m * edges)] = [force; torque / rho], torque about convention.origin, in O.
/// Tangents: t_x = n x X (n x Z when n is along X), t_y = n x t_x; edge j at angle 2 pi j / edges. Soft finger:
/// latitudes 90, 45, 0, -45, -90 degrees with 1, 5, 8, 5, 1 directions on the ellipsoid (1, 1, torsion_radius), as
/// GraspIt! does.
Eigen::Matrix<double, 6, Eigen::Dynamic> contact_wrenches(const std::vector<Contact>& contacts,
                                                          const QualityConvention& convention);

/// Columns that contact_wrenches gives each contact: 1, edges, or a soft finger's 20.
int edges_per_contact(const QualityConvention& convention);

/// Relative gap at which epsilon of quadratic cones is good enough: it is never above the truth, and never below it by
/// more than this share.
constexpr double kQuadraticGap = 1e-3;

struct QualityRequest {
  bool volume = false;  ///< costs a convex hull (qhull); none for quadratic cones
  /// Give up, with the state below_incumbent, as soon as epsilon is known to be less than this: an incumbent's epsilon.
  std::optional<double> at_least = std::nullopt;
  double quadratic_gap = kQuadraticGap;  ///< relative, in (0, 1); quadratic cones only
};

/// Ferrari-Canny epsilon (doi:10.1109/ROBOT.1992.219918) and the min-weight metric l*. Thread-safe, no global state.
GraspQuality evaluate(const std::vector<Contact>& contacts, const QualityConvention& convention,
                      const QualityRequest& request = {});

}  // namespace opponens::grasp
