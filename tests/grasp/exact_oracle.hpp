// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdlib>
#include <vector>

#include <CGAL/Gmpq.h>
#include <CGAL/Gmpzf.h>
#include <CGAL/Linear_algebraCd.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include "core/grasp.hpp"
#include "grasp/quality.hpp"

namespace opponens::test {

/// Forces and torsions of the convention's edges as doubles, and exact wrenches of them about O's origin.
inline std::vector<std::array<CGAL::Gmpzf, 6>> oracle_wrenches(const std::vector<Contact>& contacts,
                                                               QualityConvention convention) {
  using Number = CGAL::Gmpzf;
  std::vector<std::array<Number, 6>> wrenches;
  for (const Contact& contact : contacts) {
    convention.origin = contact.p_OC;
    convention.rho = 1.0;
    const auto edges = grasp::contact_wrenches({contact}, convention);
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      std::array<Number, 6> w;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        w[static_cast<std::size_t>(i)] = Number(edges(i, e));
        w[static_cast<std::size_t>(i + 3)] = Number(contact.p_OC[j]) * Number(edges(k, e)) -
                                             Number(contact.p_OC[k]) * Number(edges(j, e)) + Number(edges(i + 3, e));
      }
      wrenches.push_back(w);
    }
  }
  return wrenches;
}

/// Whether W a = 0 has a solution a >= 1, by CGAL's linear programme over all wrenches, with a = 1 + b, b >= 0.
inline bool balance(const std::vector<std::array<CGAL::Gmpzf, 6>>& wrenches) {
  using Number = CGAL::Gmpzf;
  CGAL::Quadratic_program<Number> programme(CGAL::EQUAL, true, 0, false, 0);
  for (std::size_t i = 0; i < 6; ++i) {
    Number sum(0);
    for (std::size_t j = 0; j < wrenches.size(); ++j) {
      programme.set_a(static_cast<int>(j), static_cast<int>(i), wrenches[j][i]);
      sum += wrenches[j][i];
    }
    programme.set_b(static_cast<int>(i), -sum);
  }
  return !CGAL::solve_nonnegative_linear_program(programme, Number()).is_infeasible();
}

inline int exact_rank(const std::vector<std::array<CGAL::Gmpzf, 6>>& wrenches) {
  using Algebra = CGAL::Linear_algebraCd<CGAL::Gmpq>;
  Algebra::Matrix rows(6, static_cast<int>(wrenches.size()));
  for (std::size_t j = 0; j < wrenches.size(); ++j) {
    for (std::size_t i = 0; i < 6; ++i) {
      CGAL::Gmpq entry(wrenches[j][i].man());
      const long exponent = wrenches[j][i].exp();
      const CGAL::Gmpq factor = exponent > 0 ? CGAL::Gmpq(2) : CGAL::Gmpq(1, 2);
      for (long s = 0; s < std::abs(exponent); ++s) entry *= factor;
      rows(static_cast<int>(i), static_cast<int>(j)) = entry;
    }
  }
  return wrenches.empty() ? 0 : Algebra::rank(rows);
}

/// Whether the wrenches positively span R^6: what a certificate says. Exact.
inline bool positively_span(const std::vector<std::array<CGAL::Gmpzf, 6>>& wrenches) {
  return exact_rank(wrenches) == 6 && balance(wrenches);
}

}  // namespace opponens::test
