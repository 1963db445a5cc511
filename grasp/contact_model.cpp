// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include <Eigen/Geometry>

#include "grasp/contact_frame.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {

Eigen::Matrix<double, 6, Eigen::Dynamic> contact_wrenches(const std::vector<Contact>& contacts,
                                                          const QualityConvention& convention) {
  require_contacts(contacts, convention);
  const std::vector<Eigen::Vector3d> edges = friction_edges(convention);
  Eigen::Matrix<double, 6, Eigen::Dynamic> wrenches(6, static_cast<Eigen::Index>(contacts.size() * edges.size()));
  Eigen::Index column = 0;
  for (const Contact& contact : contacts) {
    const ContactFrame frame = contact_frame(contact.n_O);
    const Eigen::Vector3d arm = contact.p_OC - convention.origin;
    for (const Eigen::Vector3d& e : edges) {
      const Eigen::Vector3d force = frame.n + contact.mu * (e.x() * frame.t_x + e.y() * frame.t_y);
      wrenches.col(column).head<3>() = force;
      wrenches.col(column).tail<3>() = (arm.cross(force) + frame.n * (contact.mu * e.z())) / convention.rho;
      if (convention.unit == ForceUnit::force) wrenches.col(column) /= force.norm();
      ++column;
    }
  }
  return wrenches;
}

}  // namespace opponens::grasp
