// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"

namespace opponens::grasp {

struct ContactGradient {
  Eigen::Matrix3Xd position;  ///< [3 x m] d/dp_OC, per m
  Eigen::Matrix3Xd normal;    ///< [3 x m] d/dn_O in the plane orthogonal to n_O: the length of a normal does not count
};

/// The chain rule through contact_wrenches: from wrench_slope = dl/dW [6 x (m edges)] of any scalar l to dl/dp and
/// dl/dn, with the tangents turning with n as the convention says. Friction, rho and origin are held fixed; where rho
/// or the origin move with the contacts, the caller adds their part. The tangent rule has no derivative where n is
/// along X (it switches to Z there: hairy ball), and the slope of the turning tangents grows as 1/|n x X| near it; the
/// set of wrenches of a true cone does not turn, a pyramid's does. Cost: about 100 flops per edge.
ContactGradient contact_gradient(const std::vector<Contact>& contacts, const QualityConvention& convention,
                                 const Eigen::Matrix<double, 6, Eigen::Dynamic>& wrench_slope);

/// The Jacobian of contact i's primitive wrenches [6 edges x 6]: columns d/dp_OC (3) and d/dn_O (3), rows wrench by
/// wrench. Forward form of the above, for least squares and constraints.
Eigen::Matrix<double, Eigen::Dynamic, 6> wrench_jacobian(const Contact& contact, const QualityConvention& convention);

}  // namespace opponens::grasp
