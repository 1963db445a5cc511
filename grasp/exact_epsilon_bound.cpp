// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gmpxx.h>

#include "core/require.hpp"
#include "grasp/certificate.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

using Rational = mpq_class;
using RationalVector = std::array<Rational, 3>;

/// An edge in doubles is off by less than this share of its length: normal, tangents, cosine and length are each good
/// to some 1e-15, whatever the order they are computed in.
const double kEdgeError = std::ldexp(1.0, -45);

RationalVector rational(const Eigen::Vector3d& v) { return {Rational(v.x()), Rational(v.y()), Rational(v.z())}; }
Rational rational_dot(const RationalVector& a, const RationalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Rational sum_of_sizes(const RationalVector& v) { return abs(v[0]) + abs(v[1]) + abs(v[2]); }

/// rho times the largest u'w over the edges of one contact, and what the edges' rounding may add to it.
Rational contact_support(const Contact& contact, const QualityConvention& convention, const RationalVector& u_force,
                         const RationalVector& u_torque) {
  QualityConvention about_contact = convention;
  about_contact.origin = contact.p_OC;
  about_contact.rho = 1.0;
  const auto edges = contact_wrenches({contact}, about_contact);
  const RationalVector p = rational(contact.p_OC);
  const RationalVector o = rational(convention.origin);
  const RationalVector arm{p[0] - o[0], p[1] - o[1], p[2] - o[2]};
  // rho u'w = f.(rho u_f + u_t x arm) + u_t.(torque about the contact).
  const Rational rho(convention.rho);
  const RationalVector& t = u_torque;
  const RationalVector g{rho * u_force[0] + t[1] * arm[2] - t[2] * arm[1],
                         rho * u_force[1] + t[2] * arm[0] - t[0] * arm[2],
                         rho * u_force[2] + t[0] * arm[1] - t[1] * arm[0]};
  Rational largest;
  for (Eigen::Index j = 0; j < edges.cols(); ++j) {
    const RationalVector force = rational(edges.col(j).head<3>());
    const RationalVector torque = rational(edges.col(j).tail<3>());
    const Rational value =
        rational_dot(force, g) + rational_dot(torque, t) +
        Rational(kEdgeError) * (sum_of_sizes(force) * sum_of_sizes(g) + sum_of_sizes(torque) * sum_of_sizes(t));
    if (j == 0 || value > largest) largest = value;
  }
  return largest;
}

/// The least double r with r >= value / |u|, given |u|^2, of which neither is far from 1.
double quotient_rounded_up(const Rational& value, const Rational& squared_length) {
  const auto at_least = [&](double r) {
    const Rational product = Rational(r) * Rational(r) * squared_length;
    const Rational squared = value * value;
    if (value > 0) return r > 0.0 && product >= squared;
    return r >= 0.0 || product <= squared;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  double r = value.get_d() / std::sqrt(squared_length.get_d());
  if (!std::isfinite(r)) return infinity;  // of no use, but true
  while (at_least(r)) r = std::nextafter(r, -infinity);
  while (!at_least(r)) r = std::nextafter(r, infinity);
  return r;
}

}  // namespace

double epsilon_bound(const std::vector<Contact>& contacts, const QualityConvention& convention,
                     const Eigen::Matrix<double, 6, 1>& direction) {
  require(direction.allFinite() && !direction.isZero(0.0), "epsilon_bound: the direction must be finite and not zero");
  require(!contacts.empty(), "epsilon_bound: there must be a contact");
  // To a largest entry in [1, 2), by a power of two and so without rounding.
  const double scale = std::ldexp(1.0, -std::ilogb(direction.cwiseAbs().maxCoeff()));
  const RationalVector u_force = rational(scale * direction.head<3>());
  const RationalVector u_torque = rational(scale * direction.tail<3>());
  Rational support;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Rational value = contact_support(contacts[i], convention, u_force, u_torque);
    if (convention.norm == WrenchNorm::linf) {
      if (value > 0) support += value;
    } else if (i == 0 || value > support) {
      support = value;
    }
  }
  return quotient_rounded_up(support / Rational(convention.rho),
                             rational_dot(u_force, u_force) + rational_dot(u_torque, u_torque));
}

}  // namespace opponens::grasp
