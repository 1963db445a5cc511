// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "grasp/exact_balance.hpp"

namespace opponens::grasp {

/// The edges with which sum weights w_given + sum x w = 0 has a solution x >= 0: at most six, those of a basic
/// solution of that linear programme, found in exact arithmetic by CGAL's simplex method. nullopt: it has no solution,
/// which is certain. Some ms for a hundred edges: only for what doubles cannot decide.
std::optional<std::vector<int>> exact_conic_basis(const std::vector<CertificateEdge>& edges,
                                                  const std::vector<Contact>& contacts, const GivenEdges& given);

}  // namespace opponens::grasp
