// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"

namespace opponens::grasp {

/// Axes of a contact in O, right-handed in the order n, t_x, t_y.
struct ContactFrame {
  Eigen::Vector3d n;          ///< unit, into the object
  Eigen::Vector3d t_x;        ///< unit: n x X, or n x Z where n is along X (|n x X| < 1e-6)
  Eigen::Vector3d t_y;        ///< unit: n x t_x
  Eigen::Vector3d reference;  ///< X or Z: the axis that t_x was made with
  double sine;                ///< |n x reference|
};

/// The convention's tangents (reference data of GraspIt!). normal: any length but zero.
ContactFrame contact_frame(const Eigen::Vector3d& normal);

/// Friction edges (e_x, e_y, e_z) of a contact: the contact's force is n + mu (e_x t_x + e_y t_y) and its torque about
/// its own normal mu e_z; e_x, e_y without unit, e_z in m. Point with friction: (cos, sin)(2 pi j / edges).
/// Soft finger: rays at latitudes 90, 45, 0, -45, -90 degrees with 1, 5, 8, 5, 1 directions leave the ellipsoid with
/// semi-axes (1, 1, torsion_radius), as GraspIt! draws them.
std::vector<Eigen::Vector3d> friction_edges(const QualityConvention& convention);

/// Throws std::invalid_argument, naming contact, value and constraint, when wrenches cannot be made of these.
void require_contacts(const std::vector<Contact>& contacts, const QualityConvention& convention);

/// Grasp map G [6 x c m], c = 1 (frictionless), 3 (point with friction) or 4 (soft finger): contact i's columns are the
/// wrenches [force; torque / rho] of a unit force along n, t_x, t_y and of a unit torque (1 N m) about n, about
/// convention.origin, in O. G f is the wrench of contact forces f given in the contact frames (Murray, Li and Sastry
/// 1994, section 5.2; Prattichizzo and Trinkle 2016, doi:10.1007/978-3-319-32552-1_38). The force unit does not enter.
Eigen::Matrix<double, 6, Eigen::Dynamic> grasp_map(const std::vector<Contact>& contacts,
                                                   const QualityConvention& convention);

}  // namespace opponens::grasp
