// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/certificate.hpp"

#include <array>
#include <cmath>
#include <optional>

#include <gmpxx.h>

#include "verify/closure.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {
namespace {

using Rational = mpq_class;
using Triple = std::array<Rational, 3>;
using Sextuple = std::array<Rational, 6>;

Triple triple(const Eigen::Vector3d& v) { return {Rational(v.x()), Rational(v.y()), Rational(v.z())}; }

Rational inner(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Rational size(const Triple& v) { return abs(v[0]) + abs(v[1]) + abs(v[2]); }

std::optional<Rational> coefficient(const std::string& text) {
  if (text.empty() || text.front() == '0' || text.find_first_not_of("0123456789") != std::string::npos) return {};
  return Rational(text);
}

bool finite(const CertificateEdge& edge, const Contact& contact) {
  return edge.force.allFinite() && std::isfinite(edge.torsion) && contact.p_OC.allFinite() && contact.n_O.allFinite() &&
         std::isfinite(contact.mu) && contact.mu >= 0.0;
}

bool inside_cone(const CertificateEdge& edge, const Contact& contact, const QualityConvention& convention) {
  const Triple f = triple(edge.force);
  const Triple n = triple(contact.n_O);
  const Rational mu(convention.model == ContactModel::frictionless ? 0.0 : contact.mu);
  const Rational along = inner(f, n);
  if (along <= 0) return false;
  Rational needed = inner(f, f) * inner(n, n);
  if (edge.torsion != 0.0) {
    const bool possible = convention.model == ContactModel::soft_finger && convention.torsion_radius > 0.0 &&
                          std::isfinite(convention.torsion_radius);
    if (!possible) return false;
    const Rational twist = Rational(edge.torsion) * inner(n, n) / Rational(convention.torsion_radius);
    needed += twist * twist;
  }
  return needed <= (1 + mu * mu) * along * along;
}

/// Takes a wrench into the rows of an echelon form when it is independent of them; each row has its leading entry
/// where `leads` says.
void add_row(Sextuple wrench, std::vector<Sextuple>& rows, std::vector<std::size_t>& leads) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Rational factor = wrench[leads[k]] / rows[k][leads[k]];
    if (factor == 0) continue;
    for (std::size_t i = 0; i < 6; ++i) wrench[i] -= factor * rows[k][i];
  }
  for (std::size_t i = 0; i < 6; ++i) {
    if (wrench[i] == 0) continue;
    rows.push_back(wrench);
    leads.push_back(i);
    return;
  }
}

}  // namespace

std::string certificate_fault(const Certificate& certificate, const std::vector<Contact>& contacts,
                              const QualityConvention& convention) {
  Sextuple sum;
  std::vector<Sextuple> rows;
  std::vector<std::size_t> leads;
  for (std::size_t k = 0; k < certificate.edges.size(); ++k) {
    const CertificateEdge& edge = certificate.edges[k];
    const std::string name = "edge " + std::to_string(k);
    if (edge.contact < 0 || static_cast<std::size_t>(edge.contact) >= contacts.size()) {
      return name + " is at contact " + std::to_string(edge.contact) + ", of which there is none";
    }
    const Contact& contact = contacts[static_cast<std::size_t>(edge.contact)];
    if (!finite(edge, contact)) return name + " or its contact is not finite";
    if (!inside_cone(edge, contact, convention)) return name + " is outside the friction cone of its contact";
    const auto weight = coefficient(edge.coefficient);
    if (!weight) return name + " has the coefficient '" + edge.coefficient.substr(0, 20) + "', no positive integer";
    const Triple f = triple(edge.force);
    const Triple moment = cross(triple(contact.p_OC), f);
    const Triple n = triple(contact.n_O);
    Sextuple wrench;
    for (std::size_t i = 0; i < 3; ++i) {
      wrench[i] = f[i];
      wrench[i + 3] = moment[i] + Rational(edge.torsion) * n[i];
    }
    for (std::size_t i = 0; i < 6; ++i) sum[i] += *weight * wrench[i];
    if (rows.size() < 6) add_row(wrench, rows, leads);
  }
  for (const Rational& component : sum) {
    if (component != 0) return "its weighted wrenches do not add up to zero";
  }
  return rows.size() == 6 ? "" : "its wrenches have rank " + std::to_string(rows.size()) + ", not 6";
}

std::string epsilon_bound_fault(double bound, const std::vector<Contact>& contacts, const GraspQuality& quality) {
  const QualityConvention& convention = quality.convention;
  const auto& u = quality.direction;
  if (!std::isfinite(bound) || !u.allFinite() || u.isZero(0.0)) return "it or the direction is not finite, or is zero";
  if (!(quality.epsilon.value_or(0.0) <= bound)) {
    return "the stored epsilon = " + number(quality.epsilon.value_or(0.0)) + " is above it, " + number(bound);
  }
  const Rational slack(std::ldexp(1.0, -47));
  const Triple u_force = triple(u.head<3>());
  const Triple u_torque = triple(u.tail<3>());
  Rational reach;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Triple p = triple(contacts[c].p_OC);
    const Triple o = triple(convention.origin);
    Triple g = cross(u_torque, {p[0] - o[0], p[1] - o[1], p[2] - o[2]});
    for (std::size_t i = 0; i < 3; ++i) g[i] = g[i] / Rational(convention.rho) + u_force[i];
    const auto edges = contact_edges(contacts[c], convention);
    Rational most;
    for (Eigen::Index j = 0; j < edges.cols(); ++j) {
      const Triple force = triple(edges.col(j).head<3>());
      const Triple torque = triple(edges.col(j).tail<3>());
      const Rational value =
          inner(force, g) + slack * size(force) * size(g) +
          (inner(torque, u_torque) + slack * size(torque) * size(u_torque)) / Rational(convention.rho);
      if (j == 0 || value > most) most = value;
    }
    if (convention.norm == WrenchNorm::l1) {
      if (c == 0 || most > reach) reach = most;
    } else if (most > 0) {
      reach += most;
    }
  }
  // reach <= bound |u|; bound is not negative, as epsilon is positive.
  const Rational limit = Rational(bound) * Rational(bound) * (inner(u_force, u_force) + inner(u_torque, u_torque));
  if (bound >= 0.0 && (reach <= 0 || reach * reach <= limit)) return "";
  return "a wrench reaches further than " + number(bound) + " in the stored direction";
}

}  // namespace opponens::verify
