// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {

/// Edges of a contact's friction cone [6 x edges] = [force; torque about the contact], made here from the convention's
/// definition: forces n + mu (cos t_x + sin t_y); without friction n alone; for a soft finger 20 edges (of quadratic
/// cones many more) on the ellipsoid |f_t|^2 + (torque/r)^2 = mu^2 with r the torsion radius. Each is checked to lie in
/// the cone (1 + mu^2) (f.n)^2 >= |f|^2 + (torque/r)^2 (to 1e-12), and scaled to a force of length 1 where that is the
/// unit.
Eigen::Matrix<double, 6, Eigen::Dynamic> contact_edges(const Contact& contact, const QualityConvention& convention);

/// Wrenches [6 x N] = [force; torque / rho] of the edges of all contacts, torque about the convention's origin.
Eigen::Matrix<double, 6, Eigen::Dynamic> contact_wrenches(const std::vector<Contact>& contacts,
                                                          const QualityConvention& convention);

struct PositiveSpan {
  bool spans = false;     ///< rank 6, and some a >= 1 has W a = 0: the wrenches positively span R^6
  double residual = 0.0;  ///< min |W a| / sum a over a >= 1, columns of W scaled to length 1
  double rank_ratio = 0;  ///< smallest over largest singular value of W so scaled
  int wrenches = 0;
};

/// Force closure of contacts by non-negative least squares.
PositiveSpan positive_span(const std::vector<Contact>& contacts, const QualityConvention& convention);

/// Residual of W a = 0, 1'a = 1, a >= l by non-negative least squares (W scaled to unit length of its longest column):
/// 0 exactly when l <= l*.
double balance_residual(const Eigen::Matrix<double, 6, Eigen::Dynamic>& wrenches, double l);

/// An upper bound of epsilon: the least value found of the support function of the wrench set over unit directions, by
/// descent from the coordinate axes, from the opposite of each contact's first wrench and from `hint`. Any direction at
/// all bounds epsilon; descent brings the bound down to it in practice. cols / per_contact contacts.
double epsilon_bound(const Eigen::Matrix<double, 6, Eigen::Dynamic>& wrenches, int per_contact, WrenchNorm norm,
                     const Eigen::Matrix<double, 6, 1>& hint);

/// Re-checks a stored quality: force closure, by positive_span and by the certificate where there is one; a positive l*
/// that is attained and, to 0.1 %, cannot be raised (balance_residual); a positive epsilon within 1 % of epsilon_bound
/// and not above it, nor above the certificate's bound. Returns the number of wrenches.
int check_quality(const std::vector<Contact>& contacts, const GraspQuality& quality,
                  const std::optional<Certificate>& certificate, Verdict& verdict);

}  // namespace opponens::verify
