// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/wrench_gradient.hpp"

#include <string>

#include <Eigen/Geometry>

#include "core/require.hpp"
#include "grasp/contact_frame.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Slope {
  Vector3d position;
  Vector3d normal;
};

/// Reverse accumulation through one contact; slope: [6 x edges].
Slope contact_slope(const Contact& contact, const QualityConvention& convention, const std::vector<Vector3d>& edges,
                    const Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>& wrench_slope) {
  const ContactFrame frame = contact_frame(contact.n_O);
  const Vector3d arm = (contact.p_OC - convention.origin) / convention.rho;
  Vector3d to_arm = Vector3d::Zero();
  Vector3d to_n = Vector3d::Zero();
  Vector3d to_x = Vector3d::Zero();
  Vector3d to_y = Vector3d::Zero();
  for (std::size_t j = 0; j < edges.size(); ++j) {
    const Vector3d& e = edges[j];
    const Vector3d force = frame.n + contact.mu * (e.x() * frame.t_x + e.y() * frame.t_y);
    const double torsion = contact.mu * e.z() / convention.rho;
    Vector3d to_force = wrench_slope.col(static_cast<Eigen::Index>(j)).head<3>();
    Vector3d to_torque = wrench_slope.col(static_cast<Eigen::Index>(j)).tail<3>();
    if (convention.unit == ForceUnit::force) {
      // w = v / |f|: the slope at v, and what shrinks as |f| grows.
      const double length = force.norm();
      const double along = to_force.dot(force) + to_torque.dot(arm.cross(force) + torsion * frame.n);
      to_force = to_force / length - force * (along / (length * length * length));
      to_torque /= length;
    }
    to_arm += force.cross(to_torque);
    to_force += to_torque.cross(arm);
    to_n += to_force + torsion * to_torque;
    to_x += contact.mu * e.x() * to_force;
    to_y += contact.mu * e.y() * to_force;
  }
  // t_y = n x t_x, then t_x = s / |s| with s = n x reference.
  to_n += frame.t_x.cross(to_y);
  to_x += to_y.cross(frame.n);
  const Vector3d to_s = (to_x - frame.t_x * frame.t_x.dot(to_x)) / frame.sine;
  to_n += frame.reference.cross(to_s);
  const Vector3d in_plane = to_n - frame.n * frame.n.dot(to_n);
  return {to_arm / convention.rho, in_plane / contact.n_O.norm()};
}

}  // namespace

ContactGradient contact_gradient(const std::vector<Contact>& contacts, const QualityConvention& convention,
                                 const Eigen::Matrix<double, 6, Eigen::Dynamic>& wrench_slope) {
  require_contacts(contacts, convention);
  const std::vector<Vector3d> edges = friction_edges(convention);
  const auto per_contact = static_cast<Eigen::Index>(edges.size());
  const auto count = static_cast<Eigen::Index>(contacts.size());
  require(wrench_slope.cols() == per_contact * count, "contact_gradient: expected " +
                                                          std::to_string(per_contact * count) + " columns, got " +
                                                          std::to_string(wrench_slope.cols()));
  ContactGradient gradient{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Slope slope = contact_slope(contacts[static_cast<std::size_t>(i)], convention, edges,
                                      wrench_slope.middleCols(per_contact * i, per_contact));
    gradient.position.col(i) = slope.position;
    gradient.normal.col(i) = slope.normal;
  }
  return gradient;
}

Eigen::Matrix<double, Eigen::Dynamic, 6> wrench_jacobian(const Contact& contact, const QualityConvention& convention) {
  require_contacts({contact}, convention);
  const std::vector<Vector3d> edges = friction_edges(convention);
  const auto count = static_cast<Eigen::Index>(edges.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(6 * count, 6);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index row = 0; row < 6; ++row) {
      const Eigen::Matrix<double, 6, Eigen::Dynamic> unit = Eigen::Matrix<double, 6, 1>::Unit(row);
      const Slope slope = contact_slope(contact, convention, {edges[static_cast<std::size_t>(j)]}, unit);
      jacobian.row(6 * j + row) << slope.position.transpose(), slope.normal.transpose();
    }
  }
  return jacobian;
}

}  // namespace opponens::grasp
