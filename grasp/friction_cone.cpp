// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/friction_cone.hpp"

#include <cmath>
#include <numbers>

#include "grasp/contact_frame.hpp"

namespace opponens::grasp {
namespace {

/// The latitude psi of a soft finger's extreme edge (sin psi along the tangent, r cos psi about the normal) under the
/// unit force. d/dpsi of (n + mu t sin psi + mu r tau cos psi) / sqrt(1 + mu^2 sin^2 psi) has the sign of
///   t / sin psi - r tau (1 + mu^2) / cos psi - mu n,
/// which falls strictly on (0, pi/2): one root, or none and an extreme end where t or tau is zero.
/// Arguments: the direction's parts along the normal force, the tangent (>= 0), and r times that about the normal (>=
/// 0).
double extreme_latitude(double along_n, double along_t, double along_torque, double mu) {
  const double k = along_torque * (1.0 + mu * mu);
  const double m = mu * along_n;
  double low = 0.0;
  double high = 0.5 * std::numbers::pi;
  double psi = along_t > 0.0 && k > 0.0 ? std::atan2(along_t, k) : 0.25 * std::numbers::pi;  // the root for n = 0
  for (int i = 0; i < 100 && high - low > 1e-15; ++i) {
    const double s = std::sin(psi);
    const double c = std::cos(psi);
    const double f = along_t * c - k * s - m * s * c;  // times sin cos: no poles, the same sign
    (f > 0.0 ? low : high) = psi;
    const double slope = -along_t * s - k * c - m * (c * c - s * s);
    const double next = psi - f / slope;
    if (std::abs(next - psi) < 1e-16) break;
    psi = slope < 0.0 && next > low && next < high ? next : 0.5 * (low + high);
  }
  return psi;
}

}  // namespace

QuadraticContact::QuadraticContact(const Contact& contact, const QualityConvention& convention)
    : axes_(Eigen::Matrix<double, 6, 3>::Zero()),
      mu_(contact.mu),
      torsion_radius_(convention.model == ContactModel::soft_finger ? convention.torsion_radius : 0.0),
      friction_(convention.model != ContactModel::frictionless),
      unit_force_(convention.unit == ForceUnit::force) {
  const Matrix6Xd G = grasp_map({contact}, convention);
  center_ = G.col(0);
  axes_.leftCols(G.cols() - 1) = G.rightCols(G.cols() - 1);
}

Vector6d QuadraticContact::support(const Vector6d& u) const {
  if (!friction_) return center_;
  const Eigen::Vector3d along = axes_.transpose() * u;
  const double tangent = std::hypot(along.x(), along.y());
  const double torque = torsion_radius_ * std::abs(along.z());
  const double length = std::hypot(tangent, torque);
  // Where u does not tell edges apart, any is extreme.
  double psi = length > 0.0 ? std::atan2(tangent, torque) : 0.5 * std::numbers::pi;
  if (unit_force_ && torsion_radius_ > 0.0) psi = extreme_latitude(u.dot(center_), tangent, torque, mu_);
  const double s = std::sin(psi);
  const Eigen::Vector2d t = tangent > 0.0 ? Eigen::Vector2d(along.head<2>() / tangent) : Eigen::Vector2d::UnitX();
  const Eigen::Vector3d e(s * t.x(), s * t.y(), std::copysign(torsion_radius_ * std::cos(psi), along.z()));
  const Vector6d wrench = center_ + mu_ * (axes_ * e);
  return unit_force_ ? Vector6d(wrench / std::hypot(1.0, mu_ * s)) : wrench;
}

double QuadraticContact::scale() const {
  return center_.norm() + mu_ * (axes_.col(0).norm() + axes_.col(1).norm() + torsion_radius_ * axes_.col(2).norm());
}

}  // namespace opponens::grasp
