// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/exact_edges.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

constexpr int kFineBits = 48;          // five less than a double has: its own rounding is below the quantum
constexpr double kMostGiven = 1.0e-3;  // of the friction, for rounding
constexpr double kMostFriction = 1e6;  // what is inside this cone is inside a wider one too

/// The largest power of two that is not above x.
double power_of_two(double x) { return std::ldexp(1.0, std::ilogb(x)); }

double rounded(double x, double quantum) { return std::nearbyint(x / quantum) * quantum; }

/// How much of the friction is kept so that rounding by `quantum` (relative to max(1, mu)) stays inside the cone: a
/// force moves by less than sqrt(3)/2 quantum, along the normal and across it.
double kept_friction(double mu, double quantum) { return 1.0 - 4.0 * quantum * std::max(1.0, mu) * (1.0 + mu) / mu; }

CertificateEdge along_normal(int contact, const Contact& at) { return {contact, at.n_O, 0.0, {}}; }

/// An edge of unit normal force as contact_wrenches has it, [force; torque about the contact point], moved inside.
CertificateEdge inner_edge(int contact, const Contact& at, const Vector6d& nominal, double kept, double quantum) {
  const Eigen::Vector3d n = at.n_O.normalized();
  const double grid = quantum * power_of_two(std::max(1.0, at.mu));
  CertificateEdge edge{contact, n + kept * (nominal.head<3>() - n), 0.0, {}};
  for (double& component : edge.force) component = rounded(component, grid);
  // The stored normal is a unit vector to 1e-6 only, and the torque is torsion * n_O.
  const double torsion = kept * nominal.tail<3>().dot(n) / at.n_O.norm();
  if (torsion != 0.0) edge.torsion = rounded(torsion, quantum * power_of_two(std::abs(torsion)));
  return edge;
}

}  // namespace

std::vector<CertificateEdge> inner_edges(const std::vector<Contact>& contacts, const QualityConvention& convention,
                                         int fraction_bits) {
  std::vector<CertificateEdge> edges;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const int index = static_cast<int>(i);
    Contact contact = contacts[i];
    contact.mu = std::min(contact.mu, kMostFriction);
    double quantum = std::ldexp(1.0, -fraction_bits);
    double kept = 0.0;
    if (convention.model != ContactModel::frictionless && contact.mu > 0.0) {
      kept = kept_friction(contact.mu, quantum);
      if (kept < 1.0 - kMostGiven) {
        quantum = std::ldexp(1.0, -kFineBits);
        kept = kept_friction(contact.mu, quantum);
      }
    }
    QualityConvention about_contact = convention;
    about_contact.unit = ForceUnit::normal;
    about_contact.origin = contact.p_OC;
    about_contact.rho = 1.0;
    const Matrix6Xd nominal = contact_wrenches({contact}, about_contact);
    if (kept < 1.0 - kMostGiven) {
      edges.push_back(along_normal(index, contact));
      continue;
    }
    for (Eigen::Index j = 0; j < nominal.cols(); ++j) {
      edges.push_back(inner_edge(index, contact, nominal.col(j), kept, quantum));
    }
  }
  return edges;
}

Matrix6Xd scaled_wrenches(const std::vector<CertificateEdge>& edges, const std::vector<Contact>& contacts) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Contact& contact : contacts) center += contact.p_OC / static_cast<double>(contacts.size());
  double length = 0.0;
  for (const Contact& contact : contacts) length = std::max(length, (contact.p_OC - center).norm());
  for (const CertificateEdge& edge : edges) length = std::max(length, std::abs(edge.torsion));
  Matrix6Xd wrenches = Matrix6Xd::Zero(6, static_cast<Eigen::Index>(edges.size()));
  for (std::size_t j = 0; j < edges.size(); ++j) {
    const Contact& contact = contacts[static_cast<std::size_t>(edges[j].contact)];
    auto wrench = wrenches.col(static_cast<Eigen::Index>(j));
    wrench.head<3>() = edges[j].force;
    if (length == 0.0) continue;
    const Eigen::Vector3d arm = (contact.p_OC - center) / length;
    wrench.tail<3>() = arm.cross(edges[j].force) + (edges[j].torsion / length) * contact.n_O;
  }
  return wrenches;
}

}  // namespace opponens::grasp
