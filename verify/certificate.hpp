// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/grasp.hpp"

namespace opponens::verify {

/// What is wrong with a certificate of force closure (core/grasp.hpp); empty: it holds. Every double is read as the
/// rational number that it is, and nothing is solved: edges in their cones, f.n > 0 and
/// |f|^2 |n|^2 + (torsion/r)^2 |n|^4 <= (1 + mu^2) (f.n)^2 (r the torsion radius; mu = 0 without friction, no torsion
/// but of a soft finger); coefficients positive integers; weighted wrenches that add up to zero; rank 6 by elimination.
[[nodiscard]] std::string certificate_fault(const Certificate& certificate, const std::vector<Contact>& contacts,
                                            const QualityConvention& convention);

/// What is wrong with a bound of epsilon; empty: it holds. No wrench of the convention's set reaches further than bound
/// times |u| in the quality's direction u: rational numbers on the edges of closure.hpp, plus 7e-15 of their size for
/// their own rounding. And the stored epsilon is not above the bound.
[[nodiscard]] std::string epsilon_bound_fault(double bound, const std::vector<Contact>& contacts,
                                              const GraspQuality& quality);

}  // namespace opponens::verify
