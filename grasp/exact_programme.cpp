// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/exact_programme.hpp"

#include <array>

#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

namespace opponens::grasp {
namespace {

using Number = CGAL::Gmpzf;  // m 2^e: sums and products of doubles without rounding

std::array<Number, 6> programme_wrench(const CertificateEdge& edge, const Contact& contact) {
  std::array<Number, 6> w;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const auto number = [](double x) { return Number(x); };
    w[static_cast<std::size_t>(i)] = number(edge.force[i]);
    w[static_cast<std::size_t>(i + 3)] = number(contact.p_OC[j]) * number(edge.force[k]) -
                                         number(contact.p_OC[k]) * number(edge.force[j]) +
                                         number(edge.torsion) * number(contact.n_O[i]);
  }
  return w;
}

}  // namespace

std::optional<std::vector<int>> exact_conic_basis(const std::vector<CertificateEdge>& edges,
                                                  const std::vector<Contact>& contacts, const GivenEdges& given) {
  std::vector<std::array<Number, 6>> wrenches;
  for (const CertificateEdge& edge : edges) {
    wrenches.push_back(programme_wrench(edge, contacts[static_cast<std::size_t>(edge.contact)]));
  }
  CGAL::Quadratic_program<Number> programme(CGAL::EQUAL, true, 0, false, 0);  // A x = b, x >= 0
  for (std::size_t i = 0; i < 6; ++i) {
    Number sum(0);
    for (std::size_t k = 0; k < given.edges.size(); ++k) {
      sum -= Number(given.weights[k]) * wrenches[static_cast<std::size_t>(given.edges[k])][i];
    }
    programme.set_b(static_cast<int>(i), sum);
    for (std::size_t j = 0; j < wrenches.size(); ++j) {
      programme.set_a(static_cast<int>(j), static_cast<int>(i), wrenches[j][i]);
    }
  }
  const auto solution = CGAL::solve_nonnegative_linear_program(programme, Number());
  if (solution.is_infeasible()) return std::nullopt;
  std::vector<int> basis;
  int j = 0;
  for (auto value = solution.variable_values_begin(); value != solution.variable_values_end(); ++value, ++j) {
    if (CGAL::sign(*value) == CGAL::POSITIVE) basis.push_back(j);
  }
  return basis;
}

}  // namespace opponens::grasp
