// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

struct QualityRequest {
  bool volume = false;  ///< costs a convex hull (qhull)
};

/// Ferrari-Canny epsilon (doi:10.1109/ROBOT.1992.219918) and the min-weight metric l*. Thread-safe, no global state.
GraspQuality evaluate(const std::vector<Contact>& contacts, const QualityConvention& convention,
                      const QualityRequest& request = {});

}  // namespace opponens::grasp
