// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/exact_balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <gmpxx.h>

#include "core/require.hpp"
#include "grasp/certificate.hpp"

namespace opponens::grasp {
namespace {

using Integer = mpz_class;

/// mantissa * 2^exponent: every double is one, and sums and products of these are again.
struct Dyadic {
  Integer mantissa;
  int exponent = 0;
};

Dyadic exact(double x) {
  if (x == 0.0) return {};
  int exponent = 0;
  const Integer mantissa(std::ldexp(std::frexp(x, &exponent), 53));
  const auto zeros = mpz_scan1(mantissa.get_mpz_t(), 0);
  return {mantissa >> zeros, exponent - 53 + static_cast<int>(zeros)};
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) { return {a.mantissa * b.mantissa, a.exponent + b.exponent}; }

Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (a.mantissa == 0) return b;
  if (b.mantissa == 0) return a;
  if (a.exponent > b.exponent) return b + a;
  return {a.mantissa + (b.mantissa << (b.exponent - a.exponent)), a.exponent};
}

Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + Dyadic{-b.mantissa, b.exponent}; }

using Vector = std::array<Dyadic, 3>;
using Wrench = std::array<Dyadic, 6>;

Vector exact(const Eigen::Vector3d& v) { return {exact(v.x()), exact(v.y()), exact(v.z())}; }
Dyadic dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Wrench exact_wrench(const CertificateEdge& edge, const Contact& contact) {
  const Vector f = exact(edge.force);
  const Vector p = exact(contact.p_OC);
  Wrench w{f[0], f[1], f[2], p[1] * f[2] - p[2] * f[1], p[2] * f[0] - p[0] * f[2], p[0] * f[1] - p[1] * f[0]};
  if (edge.torsion == 0.0) return w;
  const Dyadic torsion = exact(edge.torsion);
  for (int i = 0; i < 3; ++i) w[i + 3] = w[i + 3] + torsion * exact(contact.n_O[i]);
  return w;
}

std::vector<Wrench> exact_wrenches(const std::vector<CertificateEdge>& edges, const std::vector<Contact>& contacts) {
  std::vector<Wrench> wrenches;
  for (const CertificateEdge& edge : edges) {
    wrenches.push_back(exact_wrench(edge, contacts[static_cast<std::size_t>(edge.contact)]));
  }
  return wrenches;
}

using Rows = std::array<std::vector<Integer>, 6>;

/// The wrenches as columns of an integer matrix; each row is multiplied by a power of two, which changes neither rank
/// nor balance.
Rows integer_rows(const std::vector<Wrench>& wrenches) {
  Rows rows;
  for (std::size_t i = 0; i < 6; ++i) {
    int least = std::numeric_limits<int>::max();
    for (const Wrench& w : wrenches) {
      if (w[i].mantissa != 0) least = std::min(least, w[i].exponent);
    }
    for (const Wrench& w : wrenches) {
      rows[i].push_back(w[i].mantissa == 0 ? Integer(0) : Integer(w[i].mantissa << (w[i].exponent - least)));
    }
  }
  return rows;
}

/// Fraction-free Gauss-Jordan elimination with pivots in the leading `candidates` columns: afterwards the pivot column
/// of row i is a multiple of the i-th unit vector, the same multiple for each. Returns the pivot columns.
std::vector<int> eliminate(Rows& rows, std::size_t candidates) {
  std::vector<int> pivots;
  Integer previous = 1;
  for (std::size_t column = 0; column < candidates && pivots.size() < 6; ++column) {
    const std::size_t rank = pivots.size();
    std::size_t found = rank;
    while (found < 6 && rows[found][column] == 0) ++found;
    if (found == 6) continue;
    std::swap(rows[rank], rows[found]);
    const Integer pivot = rows[rank][column];
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == rank) continue;
      const Integer factor = rows[i][column];
      for (std::size_t j = 0; j < rows[i].size(); ++j) {
        rows[i][j] = (pivot * rows[i][j] - factor * rows[rank][j]) / previous;
      }
    }
    previous = pivot;
    pivots.push_back(static_cast<int>(column));
  }
  return pivots;
}

std::optional<Certificate> without_common_divisor(const std::vector<CertificateEdge>& edges,
                                                  const std::map<int, Integer>& weights) {
  Integer divisor = 0;
  for (const auto& [edge, weight] : weights) divisor = gcd(divisor, weight);
  Certificate certificate;
  for (const auto& [edge, weight] : weights) {
    if (weight == 0) continue;
    certificate.edges.push_back(edges[static_cast<std::size_t>(edge)]);
    certificate.edges.back().coefficient = Integer(weight / divisor).get_str();
  }
  return certificate;
}

/// f.n > 0 and |f|^2 |n|^2 + (torsion/r)^2 |n|^4 <= (1 + mu^2) (f.n)^2, multiplied by r^2 where there is a torsion.
bool in_cone(const CertificateEdge& edge, const Contact& contact, const QualityConvention& convention) {
  const Vector f = exact(edge.force);
  const Vector n = exact(contact.n_O);
  const Dyadic along = dot(f, n);
  if (along.mantissa <= 0) return false;
  const Dyadic nn = dot(n, n);
  const Dyadic mu = convention.model == ContactModel::frictionless ? Dyadic{} : exact(contact.mu);
  Dyadic margin = (Dyadic{Integer(1), 0} + mu * mu) * along * along - dot(f, f) * nn;
  if (edge.torsion != 0.0) {
    if (convention.model != ContactModel::soft_finger) return false;
    const Dyadic r = exact(convention.torsion_radius);
    const Dyadic torque = exact(edge.torsion) * nn;
    margin = r * r * margin - torque * torque;
  }
  return margin.mantissa >= 0;
}

bool positive_integer(const std::string& text) {
  return !text.empty() && text.front() != '0' &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// What is wrong with one edge by itself; empty: nothing.
std::string edge_fault(const CertificateEdge& edge, const std::vector<Contact>& contacts,
                       const QualityConvention& convention) {
  if (edge.contact < 0 || static_cast<std::size_t>(edge.contact) >= contacts.size()) return "has no such contact";
  const Contact& contact = contacts[static_cast<std::size_t>(edge.contact)];
  const bool finite = edge.force.allFinite() && std::isfinite(edge.torsion) && contact.p_OC.allFinite() &&
                      contact.n_O.allFinite() && std::isfinite(contact.mu) && contact.mu >= 0.0;
  if (!finite) return "or its contact is not finite";
  if (!in_cone(edge, contact, convention)) return "is outside the friction cone";
  if (!positive_integer(edge.coefficient)) return "has a coefficient that is no positive integer";
  return {};
}

}  // namespace

std::optional<Certificate> exact_balance(const std::vector<CertificateEdge>& edges,
                                         const std::vector<Contact>& contacts, const GivenEdges& given,
                                         const std::vector<int>& basis) {
  require(basis.size() == 6 && given.edges.size() == given.weights.size(),
          "exact_balance: a basis has six edges, and each given edge a weight");
  std::vector<CertificateEdge> chosen;
  for (const int edge : basis) chosen.push_back(edges[static_cast<std::size_t>(edge)]);
  std::vector<Wrench> wrenches = exact_wrenches(chosen, contacts);
  Wrench sum;
  for (std::size_t k = 0; k < given.edges.size(); ++k) {
    const CertificateEdge& edge = edges[static_cast<std::size_t>(given.edges[k])];
    const Wrench w = exact_wrench(edge, contacts[static_cast<std::size_t>(edge.contact)]);
    for (std::size_t i = 0; i < 6; ++i) sum[i] = sum[i] - Dyadic{Integer(given.weights[k]), 0} * w[i];
  }
  wrenches.push_back(sum);
  Rows rows = integer_rows(wrenches);
  if (eliminate(rows, 6).size() < 6) return std::nullopt;
  const Integer& determinant = rows[0][0];
  std::map<int, Integer> weights;
  for (std::size_t i = 0; i < 6; ++i) {
    const Integer numerator = determinant < 0 ? Integer(-rows[i][6]) : rows[i][6];
    if (numerator < 0) return std::nullopt;
    weights[basis[i]] += numerator;
  }
  for (std::size_t k = 0; k < given.edges.size(); ++k) weights[given.edges[k]] += given.weights[k] * abs(determinant);
  return without_common_divisor(edges, weights);
}

std::vector<int> independent_edges(const std::vector<CertificateEdge>& edges, const std::vector<Contact>& contacts,
                                   const std::vector<int>& preferred) {
  std::vector<int> order = preferred;
  for (int j = 0; j < static_cast<int>(edges.size()); ++j) {
    if (std::find(preferred.begin(), preferred.end(), j) == preferred.end()) order.push_back(j);
  }
  std::vector<CertificateEdge> ordered;
  for (const int j : order) ordered.push_back(edges[static_cast<std::size_t>(j)]);
  Rows rows = integer_rows(exact_wrenches(ordered, contacts));
  std::vector<int> independent;
  for (const int pivot : eliminate(rows, ordered.size())) independent.push_back(order[static_cast<std::size_t>(pivot)]);
  return independent;
}

std::string certificate_fault(const Certificate& certificate, const std::vector<Contact>& contacts,
                              const QualityConvention& convention) {
  if (convention.model == ContactModel::soft_finger &&
      !(std::isfinite(convention.torsion_radius) && convention.torsion_radius > 0.0)) {
    return "a soft finger's torsion radius is not positive";
  }
  for (std::size_t k = 0; k < certificate.edges.size(); ++k) {
    const std::string fault = edge_fault(certificate.edges[k], contacts, convention);
    if (!fault.empty()) return "edge " + std::to_string(k) + " " + fault;
  }
  const std::vector<Wrench> wrenches = exact_wrenches(certificate.edges, contacts);
  for (std::size_t i = 0; i < 6; ++i) {
    Dyadic sum;
    for (std::size_t k = 0; k < wrenches.size(); ++k) {
      sum = sum + Dyadic{Integer(certificate.edges[k].coefficient), 0} * wrenches[k][i];
    }
    if (sum.mantissa != 0) return "the weighted wrenches do not add up to zero";
  }
  Rows rows = integer_rows(wrenches);
  const std::size_t rank = eliminate(rows, wrenches.size()).size();
  return rank == 6 ? "" : "the wrenches have rank " + std::to_string(rank) + ", not 6";
}

}  // namespace opponens::grasp
