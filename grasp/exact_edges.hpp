// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/grasp.hpp"
#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// The convention's edges of all contacts, contact by contact, with forces rounded to multiples of 2^-fraction_bits
/// (times the power of two at or below mu, where mu > 1) and torsions likewise relative to theirs. Each is first moved
/// towards the normal by a little more than the rounding, so that it is inside the cone. Where that would cost more
/// than 1/1000 of the friction, 48 bits are used instead, and where that does too (mu below 1e-11) the stored normal.
/// Of a friction coefficient above 1e6 that much is used. Coefficients are left empty.
std::vector<CertificateEdge> inner_edges(const std::vector<Contact>& contacts, const QualityConvention& convention,
                                         int fraction_bits);

/// Wrenches of the edges in doubles [6 x N], torque about the mean of the contact points and divided by the largest
/// distance from it (at least the largest torsion): of about unit size, for whoever looks for a basis.
Matrix6Xd scaled_wrenches(const std::vector<CertificateEdge>& edges, const std::vector<Contact>& contacts);

}  // namespace opponens::grasp
