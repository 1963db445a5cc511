// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/grasp.hpp"

namespace opponens::grasp {

/// Edges whose sum is to be balanced, with how much is taken of each.
struct GivenEdges {
  std::vector<int> edges;
  std::vector<int> weights;  ///< positive
};

/// The certificate in which six edges, the basis, balance the given ones: the exact x of
/// sum weights w_given + sum x w_basis = 0 (w as in core's Certificate), all brought to integers without a common
/// divisor. An edge may be in both; one with no weight is left out. nullopt when the basis is dependent or an x is
/// negative. Fraction-free elimination (Bareiss 1968, doi:10.1090/S0025-5718-1968-0226829-0): numbers are no longer
/// than the basis's determinant, some 300 bits with forces of 20 bits.
std::optional<Certificate> exact_balance(const std::vector<CertificateEdge>& edges,
                                         const std::vector<Contact>& contacts, const GivenEdges& given,
                                         const std::vector<int>& basis);

/// Indices of edges with linearly independent wrenches: the first ones that are, in the order `preferred`, then by
/// index. Six exactly when the wrenches of all have rank 6.
std::vector<int> independent_edges(const std::vector<CertificateEdge>& edges, const std::vector<Contact>& contacts,
                                   const std::vector<int>& preferred);

}  // namespace opponens::grasp
