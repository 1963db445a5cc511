// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/closure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/SVD>

#include "core/require.hpp"
#include "verify/certificate.hpp"
#include "verify/nonnegative_least_squares.hpp"

namespace opponens::verify {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Quadratic cones are looked at through pyramids of so many edges: within 1 - cos(pi/96) = 0.05 % of the circle, and
/// twice that of the ellipsoid.
constexpr int kDenseEdges = 96;
constexpr double kDenseLoss = 0.002;

/// Edges all over the unit circle, or the unit sphere where there is torsion.
std::vector<Eigen::Vector3d> dense_edges(bool torsion) {
  std::vector<Eigen::Vector3d> edges;
  const int rings = torsion ? kDenseEdges / 4 : 0;
  for (int i = -rings; i <= rings; ++i) {
    const double latitude = rings == 0 ? 0.0 : 0.5 * std::numbers::pi * i / rings;
    const int around = std::abs(i) == rings && torsion ? 1 : kDenseEdges;
    for (int j = 0; j < around; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / around;
      edges.emplace_back(std::cos(latitude) * std::cos(angle), std::cos(latitude) * std::sin(angle),
                         std::sin(latitude));
    }
  }
  return edges;
}

/// Friction edges of a unit normal force, in units of mu: along t_x, along t_y, and (soft finger) torque about the
/// normal in units of the torsion radius. Soft fingers: rays at latitudes of 90, 45, 0, -45 and -90 degrees, drawn with
/// the torque axis in millimetres, as far as the unit sphere of these units.
std::vector<Eigen::Vector3d> unit_edges(const QualityConvention& convention) {
  if (convention.model == ContactModel::frictionless) return {Eigen::Vector3d::Zero()};
  if (convention.cone == FrictionCone::quadratic) return dense_edges(convention.model == ContactModel::soft_finger);
  std::vector<Eigen::Vector3d> edges;
  if (convention.model == ContactModel::point_with_friction) {
    for (int j = 0; j < convention.edges; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / convention.edges;
      edges.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    }
    return edges;
  }
  const double radius_mm = 1000.0 * convention.torsion_radius;
  edges.emplace_back(0.0, 0.0, 1.0);
  for (const auto& [latitude, count] : {std::pair{0.25, 5}, std::pair{0.0, 8}, std::pair{-0.25, 5}}) {
    for (int j = 0; j < count; ++j) {
      const double along = 2.0 * std::numbers::pi * j / count;
      const double up = latitude * std::numbers::pi;
      const Eigen::Vector3d ray(std::cos(up) * std::cos(along), std::cos(up) * std::sin(along),
                                std::sin(up) / radius_mm);
      edges.push_back(ray.normalized());
    }
  }
  edges.emplace_back(0.0, 0.0, -1.0);
  return edges;
}

/// Whether [force; torque about the contact] obeys f.n > 0, |f_t|^2 + (torque/r)^2 <= mu^2 f_n^2, to 1e-12.
bool in_friction_cone(const Vector6d& w, const Eigen::Vector3d& n, double mu, double torsion_radius) {
  const double along = w.head<3>().dot(n);
  const double twist = torsion_radius > 0.0 ? w.tail<3>().norm() / torsion_radius : 0.0;
  const double most = (1.0 + mu * mu) * along * along;
  return along > 0.0 && w.head<3>().squaredNorm() + twist * twist <= most * (1.0 + 1e-12);
}

/// The extreme point of the wrench set in direction u: its support function's gradient.
Vector6d extreme(const Matrix6Xd& wrenches, int per_contact, WrenchNorm norm, const Vector6d& u) {
  const Eigen::VectorXd value = wrenches.transpose() * u;
  Eigen::Index best = 0;
  if (norm == WrenchNorm::l1) {
    value.maxCoeff(&best);
    return wrenches.col(best);
  }
  Vector6d sum = Vector6d::Zero();
  for (Eigen::Index first = 0; first < wrenches.cols(); first += per_contact) {
    if (value.segment(first, per_contact).maxCoeff(&best) > 0.0) sum += wrenches.col(first + best);
  }
  return sum;
}

void check_weight(const Matrix6Xd& wrenches, double stored, Verdict& verdict) {
  constexpr double kAttained = 1e-9;
  const double excess = 1e-3 / static_cast<double>(wrenches.cols());  // of the largest l* that is possible
  if (const double residual = balance_residual(wrenches, stored); !(residual <= kAttained)) {
    verdict.fail("the stored l* = " + number(stored) + " is not attained: |W a| = " + number(residual));
  } else if (!(balance_residual(wrenches, stored + excess) > kAttained)) {
    verdict.fail("the stored l* = " + number(stored) + " is too small");
  }
}

void check_epsilon(const Matrix6Xd& wrenches, int per_contact, const GraspQuality& quality, Verdict& verdict) {
  const double stored = *quality.epsilon;
  const double bound = epsilon_bound(wrenches, per_contact, quality.convention.norm, quality.direction);
  const double loss = quality.convention.cone == FrictionCone::quadratic ? kDenseLoss * bound : 0.0;
  if (!(stored <= bound + loss + 1e-9) || !(stored >= 0.99 * bound - 1e-9)) {
    verdict.fail("the stored epsilon = " + number(stored) + " is not what was found here, " + number(bound));
  }
}

/// Whether the convention is one that wrenches can be made of.
bool check_convention(const QualityConvention& convention, Verdict& verdict) {
  const bool soft = convention.model == ContactModel::soft_finger;
  const bool cone = soft ? convention.torsion_radius > 0.0 && std::isfinite(convention.torsion_radius)
                         : convention.model == ContactModel::frictionless || convention.edges >= 3;
  if (convention.rho > 0.0 && std::isfinite(convention.rho) && convention.origin.allFinite() && cone) return true;
  verdict.fail("the quality's torque scale rho = " + number(convention.rho) +
               " m is not positive, its origin not finite, " + std::to_string(convention.edges) +
               " cone edges are fewer than 3, or a soft finger's torsion radius is not positive");
  return false;
}

}  // namespace

Matrix6Xd contact_edges(const Contact& contact, const QualityConvention& convention) {
  const Eigen::Vector3d n = contact.n_O.normalized();
  // The convention's tangents: n x X, or n x Z where n is along X.
  Eigen::Vector3d t_x(0.0, n.z(), -n.y());
  if (t_x.norm() < 1e-6) t_x = Eigen::Vector3d(n.y(), -n.x(), 0.0);
  t_x.normalize();
  const Eigen::Vector3d t_y(n.y() * t_x.z() - n.z() * t_x.y(), n.z() * t_x.x() - n.x() * t_x.z(),
                            n.x() * t_x.y() - n.y() * t_x.x());
  const bool soft = convention.model == ContactModel::soft_finger;
  const double radius = soft ? convention.torsion_radius : 0.0;
  const std::vector<Eigen::Vector3d> friction = unit_edges(convention);
  Matrix6Xd edges(6, static_cast<Eigen::Index>(friction.size()));
  for (std::size_t j = 0; j < friction.size(); ++j) {
    Vector6d edge;
    edge << n + contact.mu * (friction[j].x() * t_x + friction[j].y() * t_y),
        n * (contact.mu * radius * friction[j].z());
    require(in_friction_cone(edge, n, contact.mu, radius), "contact_edges: an edge left the friction cone");
    if (convention.unit == ForceUnit::force) edge /= edge.head<3>().norm();
    edges.col(static_cast<Eigen::Index>(j)) = edge;
  }
  return edges;
}

Matrix6Xd contact_wrenches(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  std::vector<Vector6d> columns;
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d arm = (contact.p_OC - convention.origin) / convention.rho;
    const Matrix6Xd edges = contact_edges(contact, convention);
    for (const auto& edge : edges.colwise()) {
      const Eigen::Vector3d force = edge.head<3>();
      const Eigen::Vector3d moment(arm.y() * force.z() - arm.z() * force.y(), arm.z() * force.x() - arm.x() * force.z(),
                                   arm.x() * force.y() - arm.y() * force.x());
      columns.emplace_back();
      columns.back() << force, moment + edge.tail<3>() / convention.rho;
    }
  }
  Matrix6Xd W(6, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) W.col(static_cast<Eigen::Index>(i)) = columns[i];
  return W;
}

PositiveSpan positive_span(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  Eigen::MatrixXd W = contact_wrenches(contacts, convention);
  PositiveSpan result;
  result.wrenches = static_cast<int>(W.cols());
  if (W.cols() < 7) return result;  // fewer never span R^6 positively
  W.colwise().normalize();
  const Eigen::VectorXd singular = W.jacobiSvd().singularValues();
  result.rank_ratio = singular[5] / singular[0];
  // a = 1 + b, b >= 0: W a = 0 becomes W b = -W 1.
  const NonnegativeSolution solution = nonnegative_least_squares(W, -W.rowwise().sum());
  result.residual = solution.residual / (static_cast<double>(result.wrenches) + solution.x.sum());
  result.spans = solution.converged && result.rank_ratio > 1e-8 && result.residual < 1e-10;
  return result;
}

double balance_residual(const Matrix6Xd& wrenches, double l) {
  // a = l + b, b >= 0: W b = -l W 1, 1'b = 1 - l N.
  Eigen::MatrixXd rows(7, wrenches.cols());
  rows.topRows(6) = wrenches / wrenches.colwise().norm().maxCoeff();
  rows.row(6).setOnes();
  Eigen::VectorXd right(7);
  right << -l * rows.topRows(6).rowwise().sum(), 1.0 - l * static_cast<double>(wrenches.cols());
  return nonnegative_least_squares(rows, right).residual;
}

double epsilon_bound(const Matrix6Xd& wrenches, int per_contact, WrenchNorm norm, const Vector6d& hint) {
  constexpr int kSteps = 120;
  std::vector<Vector6d> starts;
  if (hint.norm() > 0.0) starts.push_back(hint.normalized());
  for (int i = 0; i < 6; ++i) starts.insert(starts.end(), {Vector6d::Unit(i), -Vector6d::Unit(i)});
  for (Eigen::Index j = 0; j < wrenches.cols(); j += per_contact) starts.push_back(-wrenches.col(j).normalized());
  double least = std::numeric_limits<double>::infinity();
  for (Vector6d u : starts) {
    double step = 0.5;  // of the wrench's length
    for (int k = 0; k < kSteps; ++k, step *= 0.95) {
      const Vector6d w = extreme(wrenches, per_contact, norm, u);
      least = std::min(least, u.dot(w));
      u = (u - step / std::max(w.norm(), 1e-12) * w).normalized();
    }
  }
  return least;
}

int check_quality(const std::vector<Contact>& contacts, const GraspQuality& quality,
                  const std::optional<Certificate>& certificate, Verdict& verdict) {
  if (!check_convention(quality.convention, verdict)) return 0;
  const PositiveSpan span = positive_span(contacts, quality.convention);
  bool closed = span.spans;
  if (certificate) {
    const std::string fault = certificate_fault(*certificate, contacts, quality.convention);
    if (!fault.empty()) verdict.fail("the certificate of force closure does not hold: " + fault);
    verdict.certified = fault.empty();
    closed = closed || verdict.certified;  // a proof counts more than least squares in doubles
  }
  if (quality.force_closure() != closed) {
    verdict.fail(std::string(quality.force_closure() ? "stored as force closure, but its"
                                                     : "not stored as force closure, but its") +
                 " wrenches " + (closed ? "positively span" : "do not positively span") + " the space (residual " +
                 number(span.residual) + ", rank ratio " + number(span.rank_ratio) + ")");
    return span.wrenches;
  }
  if (!closed) {
    verdict.fail("not a force-closure grasp");
    return span.wrenches;
  }
  // l* is that of the pyramids: under quadratic cones it may miss a closure that needs the whole cone.
  const bool pyramid = quality.convention.cone == FrictionCone::pyramid;
  if (!(quality.epsilon.value_or(0.0) > 0.0) || (pyramid && !(quality.min_weight.value_or(0.0) > 0.0))) {
    verdict.fail("stored as force closure, but with epsilon = " + number(quality.epsilon.value_or(0.0)) +
                 " and l* = " + number(quality.min_weight.value_or(0.0)));
    return span.wrenches;
  }
  const Matrix6Xd wrenches = contact_wrenches(contacts, quality.convention);
  if (quality.min_weight) {
    QualityConvention edges = quality.convention;
    edges.cone = FrictionCone::pyramid;
    check_weight(contact_wrenches(contacts, edges), *quality.min_weight, verdict);
  }
  check_epsilon(wrenches, span.wrenches / static_cast<int>(contacts.size()), quality, verdict);
  if (certificate && certificate->epsilon_bound) {
    const std::string fault = epsilon_bound_fault(*certificate->epsilon_bound, contacts, quality);
    if (!fault.empty()) verdict.fail("the certificate's bound of epsilon does not hold: " + fault);
  }
  return span.wrenches;
}

}  // namespace opponens::verify
