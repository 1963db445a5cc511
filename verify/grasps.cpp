// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/grasps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/SVD>

#include "core/require.hpp"
#include "verify/nonnegative_least_squares.hpp"
#include "verify/solid.hpp"

namespace opponens::verify {
namespace {

bool in_friction_cone(const Eigen::Vector3d& force, const Eigen::Vector3d& n, double mu) {
  const double along = force.dot(n);
  return along > 0.0 && (1.0 + mu * mu) * along * along >= force.squaredNorm() * n.squaredNorm() * (1.0 - 1e-12);
}

/// Forces of one contact, [3] each.
std::vector<Eigen::Vector3d> contact_forces(const Contact& contact, const QualityConvention& convention) {
  const Eigen::Vector3d n = contact.n_O.normalized();
  if (convention.model == ContactModel::frictionless) return {n};
  // The convention's tangents: n x X, or n x Z where n is along X.
  Eigen::Vector3d t_x(0.0, n.z(), -n.y());
  if (t_x.norm() < 1e-6) t_x = Eigen::Vector3d(n.y(), -n.x(), 0.0);
  t_x.normalize();
  const Eigen::Vector3d t_y(n.y() * t_x.z() - n.z() * t_x.y(), n.z() * t_x.x() - n.x() * t_x.z(),
                            n.x() * t_x.y() - n.y() * t_x.x());
  std::vector<Eigen::Vector3d> forces;
  const int count = 2 * std::max(convention.edges, 3);
  for (int j = 0; j < count; ++j) {
    const double angle = 2.0 * std::numbers::pi * j / count;
    forces.push_back(n + contact.mu * (std::cos(angle) * t_x + std::sin(angle) * t_y));
    require(in_friction_cone(forces.back(), n, contact.mu), "positive_span: an edge left the friction cone");
  }
  return forces;
}

void check_pose(const Eigen::Isometry3d& X, const std::string& name, double tolerance, Verdict& verdict) {
  const Eigen::Matrix3d R = X.linear();
  const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!X.matrix().allFinite() || !(error <= tolerance) || R.determinant() < 0.0) {
    verdict.fail(name + " is no rigid pose: R'R differs from 1 by " + number(error));
  }
}

/// Whether the joint vectors have the hand's length; without that nothing else can be asked.
bool check_limits(const Grasp& grasp, const robot::RobotModel& hand, double tolerance, Verdict& verdict) {
  const auto check = [&](const Eigen::VectorXd& q, const std::string& name) {
    if (q.size() != hand.dof() || !q.allFinite()) {
      verdict.fail(name + " has " + std::to_string(q.size()) + " entries (the hand " + std::to_string(hand.dof()) +
                   ") or one that is not finite");
      return false;
    }
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      if (q[j] < hand.lower()[j] - tolerance || q[j] > hand.upper()[j] + tolerance) {
        verdict.fail(name + ": joint " + hand.joint_names()[static_cast<std::size_t>(j)] + " = " + number(q[j]) +
                     " rad is outside [" + number(hand.lower()[j]) + ", " + number(hand.upper()[j]) + "]");
      }
    }
    return true;
  };
  const bool grasp_ok = check(grasp.q_grasp, "q_grasp");
  return check(grasp.q_pregrasp, "q_pregrasp") && grasp_ok;
}

void check_synergies(const Grasp& grasp, const SynergyBox& box, const GraspCheckSettings& settings, Verdict& verdict) {
  if (grasp.coefficients.size() != box.half_width.size() || grasp.slack.size() != grasp.q_grasp.size() ||
      box.center.size() != grasp.q_grasp.size()) {
    verdict.fail("coefficients, slack or box differ in size: k = " + std::to_string(box.half_width.size()) +
                 ", n = " + std::to_string(grasp.q_grasp.size()));
    return;
  }
  const Eigen::VectorXd on_synergies =
      (box.scale.array() * (box.center + box.axes * grasp.coefficients).array()).matrix();
  const double error = (grasp.q_grasp - on_synergies - grasp.slack).cwiseAbs().maxCoeff();
  if (!(error <= settings.tolerance)) {
    verdict.fail("q_grasp differs from synergies plus slack by " + number(error) + " rad");
  }
  const double outside = (grasp.coefficients.cwiseAbs() - box.half_width).maxCoeff();
  if (!(outside <= settings.tolerance)) {
    verdict.fail("a synergy coefficient is " + number(outside) + " outside its box");
  }
  if (grasp.synergy_grasp && !(grasp.slack.norm() <= settings.slack_bound + settings.tolerance)) {
    verdict.fail("called a synergy grasp with a slack of " + number(grasp.slack.norm()) + " rad");
  }
}

struct PlacedSolid {
  Solid solid;
  Eigen::Isometry3d X_GO;
};

std::vector<PlacedSolid> place(const std::vector<robot::Geometry>& geometry, const Eigen::Isometry3d& X_OB) {
  std::vector<PlacedSolid> placed;
  placed.reserve(geometry.size());
  for (const robot::Geometry& g : geometry) placed.push_back({Solid(g.shape), (X_OB * g.X_BG).inverse()});
  return placed;
}

double surface_distance(const std::vector<PlacedSolid>& solids, const Eigen::Vector3d& p_O) {
  double least = std::numeric_limits<double>::infinity();
  for (const PlacedSolid& s : solids) least = std::min(least, s.solid.distance(s.X_GO * p_O));
  return least;
}

/// Whether the contacts are such at all.
bool check_contact_form(const Grasp& grasp, double tolerance, Verdict& verdict) {
  bool right = true;
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const Contact& contact = grasp.contacts[i];
    if (contact.p_OC.allFinite() && std::abs(contact.n_O.norm() - 1.0) <= tolerance && contact.mu >= 0.0 &&
        std::isfinite(contact.mu)) {
      continue;
    }
    right = false;
    verdict.fail("contact " + std::to_string(i) + " (" + contact.link +
                 "): position, normal or friction coefficient is no such thing; |n| = " + number(contact.n_O.norm()) +
                 ", mu = " + number(contact.mu));
  }
  return right;
}

void check_contacts(const Grasp& grasp, const GraspContext& context, const GraspCheckSettings& settings,
                    Verdict& verdict) {
  const auto object = place(context.object->geometry, Eigen::Isometry3d::Identity());
  const auto X_HL = context.hand->link_poses(grasp.q_grasp);
  const auto& links = context.hand->links();
  for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
    const Contact& contact = grasp.contacts[i];
    const std::string name = "contact " + std::to_string(i) + " (" + contact.link + ")";
    const double off_object = surface_distance(object, contact.p_OC);
    if (!(off_object <= settings.contact_distance)) {
      verdict.fail(name + " is " + number(1e3 * off_object) + " mm off the object's surface");
    }
    double angle = std::numbers::pi;
    for (const PlacedSolid& s : object) {
      angle = std::min(angle, s.solid.normal_angle(s.X_GO * contact.p_OC, s.X_GO.linear() * -contact.n_O,
                                                   settings.contact_distance));
    }
    if (!(angle <= settings.normal_angle)) {
      verdict.fail(name + ": normal is " + number(angle) + " rad off the object's surface normal");
    }
    const auto link = std::find_if(links.begin(), links.end(), [&](const auto& l) { return l.name == contact.link; });
    if (link == links.end()) {
      verdict.fail(name + ": the hand has no such link");
      continue;
    }
    const auto index = static_cast<std::size_t>(link - links.begin());
    const double off_link = surface_distance(place(link->collision, grasp.X_OH * X_HL[index]), contact.p_OC);
    if (!(off_link <= settings.contact_distance)) {
      verdict.fail(name + " is " + number(1e3 * off_link) + " mm off its link's surface");
    }
  }
}

}  // namespace

PositiveSpan positive_span(const std::vector<Contact>& contacts, const QualityConvention& convention) {
  std::vector<Eigen::Matrix<double, 6, 1>> columns;
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d arm = (contact.p_OC - convention.origin) / convention.rho;
    for (const Eigen::Vector3d& force : contact_forces(contact, convention)) {
      Eigen::Matrix<double, 6, 1> wrench;
      wrench << force, arm.y() * force.z() - arm.z() * force.y(), arm.z() * force.x() - arm.x() * force.z(),
          arm.x() * force.y() - arm.y() * force.x();
      columns.push_back(wrench.normalized());
    }
  }
  PositiveSpan result;
  result.wrenches = static_cast<int>(columns.size());
  if (columns.size() < 7) return result;  // fewer never span R^6 positively
  Eigen::MatrixXd W(6, result.wrenches);
  for (std::size_t i = 0; i < columns.size(); ++i) W.col(static_cast<Eigen::Index>(i)) = columns[i];
  const Eigen::VectorXd singular = W.jacobiSvd().singularValues();
  result.rank_ratio = singular[5] / singular[0];
  // a = 1 + b, b >= 0: W a = 0 becomes W b = -W 1.
  const NonnegativeSolution solution = nonnegative_least_squares(W, -W.rowwise().sum());
  result.residual = solution.residual / (static_cast<double>(result.wrenches) + solution.x.sum());
  result.spans = solution.converged && result.rank_ratio > 1e-8 && result.residual < 1e-10;
  return result;
}

Verdict check_grasp(const Grasp& grasp, const GraspContext& context, const GraspCheckSettings& settings) {
  require(context.box != nullptr && context.hand != nullptr && context.object != nullptr,
          "check_grasp: box, hand and object must be given");
  Verdict verdict;
  check_pose(grasp.X_OH, "X_OH", settings.tolerance, verdict);
  check_pose(grasp.X_OH_pregrasp, "X_OH_pregrasp", settings.tolerance, verdict);
  if (!check_limits(grasp, *context.hand, settings.tolerance, verdict)) return verdict;
  check_synergies(grasp, *context.box, settings, verdict);
  if (!verdict.ok) return verdict;  // surfaces and wrenches of a grasp that is not itself would only add noise
  if (!check_contact_form(grasp, settings.tolerance, verdict)) return verdict;
  check_contacts(grasp, context, settings, verdict);
  if (!(grasp.quality.convention.rho > 0.0)) {
    verdict.fail("the quality's torque scale rho = " + number(grasp.quality.convention.rho) + " m is not positive");
    return verdict;
  }
  const PositiveSpan span = positive_span(grasp.contacts, grasp.quality.convention);
  verdict.checked = span.wrenches;
  if (grasp.quality.force_closure() != span.spans) {
    verdict.fail(std::string(grasp.quality.force_closure() ? "stored as force closure, but its"
                                                           : "not stored as force closure, but its") +
                 " wrenches " + (span.spans ? "positively span" : "do not positively span") + " the space (residual " +
                 number(span.residual) + ", rank ratio " + number(span.rank_ratio) + ")");
  } else if (!span.spans) {
    verdict.fail("not a force-closure grasp");
  }
  return verdict;
}

}  // namespace opponens::verify
