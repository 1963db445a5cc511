// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

/// Friction edges (e_x, e_y, e_z): tangential force along t_x and t_y, torque about the normal; units of mu times the
/// normal force (and metres for e_z).
std::vector<Eigen::Vector3d> friction_edges(const QualityConvention& convention) {
  std::vector<Eigen::Vector3d> edges;
  if (convention.model == ContactModel::frictionless) return {Eigen::Vector3d::Zero()};
  if (convention.model == ContactModel::point_with_friction) {
    for (int j = 0; j < convention.edges; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / convention.edges;
      edges.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    }
    return edges;
  }
  // Rays at these latitudes leave the ellipsoid with semi-axes (1, 1, torsion_radius in mm) here; the torque axis
  // counts in millimetres because GraspIt! does so, and the latitudes' directions depend on it.
  const std::array<double, 5> latitude = {90.0, 45.0, 0.0, -45.0, -90.0};
  const std::array<int, 5> directions = {1, 5, 8, 5, 1};
  const double r_mm = 1000.0 * convention.torsion_radius;
  for (std::size_t i = 0; i < latitude.size(); ++i) {
    const double phi = latitude[i] * std::numbers::pi / 180.0;
    for (int j = 0; j < directions[i]; ++j) {
      const double theta = 2.0 * std::numbers::pi * j / directions[i];
      const double flat = std::cos(phi);
      const double stretch = 1.0 / std::hypot(flat, std::sin(phi) / r_mm);
      edges.emplace_back(stretch * flat * std::cos(theta), stretch * flat * std::sin(theta),
                         stretch * std::sin(phi) * 1e-3);
    }
  }
  return edges;
}

void check(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  require(convention.rho > 0.0 && std::isfinite(convention.rho), "quality: rho must be positive and finite");
  require(convention.model != ContactModel::point_with_friction || convention.edges >= 3,
          "quality: a friction cone needs at least 3 edges, got " + std::to_string(convention.edges));
  require(convention.model != ContactModel::soft_finger || convention.torsion_radius > 0.0,
          "quality: a soft finger needs a positive torsion_radius");
  require(convention.origin.allFinite(), "quality: origin must be finite");
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const auto where = [&] { return "quality: contact " + std::to_string(i) + " (" + contact.link + "): "; };
    require(contact.p_OC.allFinite(), [&] { return where() + "position must be finite"; });
    require(std::abs(contact.n_O.norm() - 1.0) < 1e-6, [&] { return where() + "normal must have length 1"; });
    require(contact.mu >= 0.0 && std::isfinite(contact.mu), [&] { return where() + "mu must be >= 0"; });
  }
}

}  // namespace

Eigen::Matrix<double, 6, Eigen::Dynamic> contact_wrenches(const std::vector<Contact>& contacts,
                                                          const QualityConvention& convention) {
  check(contacts, convention);
  const std::vector<Eigen::Vector3d> edges = friction_edges(convention);
  Eigen::Matrix<double, 6, Eigen::Dynamic> wrenches(6, static_cast<Eigen::Index>(contacts.size() * edges.size()));
  Eigen::Index column = 0;
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d n = contact.n_O.normalized();
    Eigen::Vector3d t_x = n.cross(Eigen::Vector3d::UnitX());
    if (t_x.norm() < 1e-6) t_x = n.cross(Eigen::Vector3d::UnitZ());
    t_x.normalize();
    const Eigen::Vector3d t_y = n.cross(t_x);
    const Eigen::Vector3d arm = contact.p_OC - convention.origin;
    for (const Eigen::Vector3d& e : edges) {
      const Eigen::Vector3d force = n + contact.mu * (e.x() * t_x + e.y() * t_y);
      wrenches.col(column).head<3>() = force;
      wrenches.col(column).tail<3>() = (arm.cross(force) + n * (contact.mu * e.z())) / convention.rho;
      if (convention.unit == ForceUnit::force) wrenches.col(column) /= force.norm();
      ++column;
    }
  }
  return wrenches;
}

}  // namespace opponens::grasp
