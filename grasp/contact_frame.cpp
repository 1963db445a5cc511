// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/contact_frame.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include "core/require.hpp"

namespace opponens::grasp {
namespace {

std::vector<Eigen::Vector3d> soft_finger_edges(double torsion_radius) {
  // The torque axis counts in millimetres because GraspIt! does so, and the latitudes' directions depend on it.
  const std::array<double, 5> latitude = {90.0, 45.0, 0.0, -45.0, -90.0};
  const std::array<int, 5> directions = {1, 5, 8, 5, 1};
  const double r_mm = 1000.0 * torsion_radius;
  std::vector<Eigen::Vector3d> edges;
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

}  // namespace

ContactFrame contact_frame(const Eigen::Vector3d& normal) {
  ContactFrame frame;
  frame.n = normal.normalized();
  frame.reference = Eigen::Vector3d::UnitX();
  frame.t_x = frame.n.cross(frame.reference);
  if (frame.t_x.norm() < 1e-6) {
    frame.reference = Eigen::Vector3d::UnitZ();
    frame.t_x = frame.n.cross(frame.reference);
  }
  frame.sine = frame.t_x.norm();
  frame.t_x.normalize();
  frame.t_y = frame.n.cross(frame.t_x);
  return frame;
}

std::vector<Eigen::Vector3d> friction_edges(const QualityConvention& convention) {
  if (convention.model == ContactModel::frictionless) return {Eigen::Vector3d::Zero()};
  if (convention.model == ContactModel::soft_finger) return soft_finger_edges(convention.torsion_radius);
  std::vector<Eigen::Vector3d> edges;
  for (int j = 0; j < convention.edges; ++j) {
    const double angle = 2.0 * std::numbers::pi * j / convention.edges;
    edges.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  return edges;
}

void require_contacts(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  require(convention.rho > 0.0 && std::isfinite(convention.rho), "quality: rho must be positive and finite");
  require(convention.model != ContactModel::point_with_friction || convention.edges >= 3,
          "quality: a friction cone needs at least 3 edges, got " + std::to_string(convention.edges));
  require(convention.model != ContactModel::soft_finger ||
              (convention.torsion_radius > 0.0 && std::isfinite(convention.torsion_radius)),
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

Eigen::Matrix<double, 6, Eigen::Dynamic> grasp_map(const std::vector<Contact>& contacts,
                                                   const QualityConvention& convention) {
  require_contacts(contacts, convention);
  const Eigen::Index forces = convention.model == ContactModel::frictionless ? 1 : 3;
  const Eigen::Index columns = convention.model == ContactModel::soft_finger ? 4 : forces;
  Eigen::Matrix<double, 6, Eigen::Dynamic> G(6, columns * static_cast<Eigen::Index>(contacts.size()));
  Eigen::Index column = 0;
  for (const Contact& contact : contacts) {
    const ContactFrame frame = contact_frame(contact.n_O);
    const Eigen::Vector3d arm = (contact.p_OC - convention.origin) / convention.rho;
    const std::array<Eigen::Vector3d, 3> axes = {frame.n, frame.t_x, frame.t_y};
    for (Eigen::Index k = 0; k < forces; ++k) {
      G.col(column++) << axes[static_cast<std::size_t>(k)], arm.cross(axes[static_cast<std::size_t>(k)]);
    }
    if (columns == 4) G.col(column++) << Eigen::Vector3d::Zero(), frame.n / convention.rho;
  }
  return G;
}

}  // namespace opponens::grasp
