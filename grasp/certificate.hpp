// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/grasp.hpp"

namespace opponens::grasp {

/// A proof that the contacts are force closure under the convention's contact model, edges and (soft finger)
/// torsion radius; norm, force unit, rho and origin do not matter to closure. nullopt when there is none: the edges,
/// moved into the cones by about 1e-14 / mu where rounding had put them outside, do not positively span R^6.
///
/// A conic basis is found in doubles and solved for again in rational numbers (Cramer's rule by fraction-free
/// elimination, Bareiss 1968, doi:10.1090/S0025-5718-1968-0226829-0), first with forces of few bits, so that the
/// coefficients stay short; 7 edges where that suffices, 12 at most (Steinitz). Where doubles do not decide, CGAL's
/// linear programme in exact arithmetic does. Every certificate has passed certificate_fault before it is returned.
/// The same input gives the same certificate. Throws std::invalid_argument on contacts or conventions that
/// contact_wrenches refuses.
std::optional<Certificate> certify(const std::vector<Contact>& contacts, const QualityConvention& convention);

/// The same, with epsilon_bound from the quality's own direction (none where that is zero).
std::optional<Certificate> certify(const std::vector<Contact>& contacts, const GraspQuality& quality);

/// A number that epsilon does not exceed, for certain: h(u)/|u| for the direction u (not zero, need not be of length
/// 1), h the support function of the convention's wrench set (L1 or L-infinity, quality.hpp). h is evaluated in
/// rational numbers on the edges in doubles; what their own rounding can amount to, 3e-14 of the forces, is added, and
/// the quotient is rounded up. Holds for the convention's polyhedral cones, not for the round cones around which they
/// lie.
double epsilon_bound(const std::vector<Contact>& contacts, const QualityConvention& convention,
                     const Eigen::Matrix<double, 6, 1>& direction);

/// What is wrong with a certificate of these contacts, as one sentence; empty: it holds. Exact arithmetic alone: the
/// force and torsion of each edge fulfil f.n > 0 and |f|^2 |n|^2 + (torsion/r)^2 |n|^4 <= (1 + mu^2) (f.n)^2 with r the
/// torsion radius (no torsion, or mu = 0, where the model has none), coefficients are positive integers, the weighted
/// wrenches add up to zero and have rank 6.
[[nodiscard]] std::string certificate_fault(const Certificate& certificate, const std::vector<Contact>& contacts,
                                            const QualityConvention& convention);

}  // namespace opponens::grasp
