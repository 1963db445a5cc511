// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/grasps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/require.hpp"
#include "verify/palm_pose.hpp"
#include "verify/solid.hpp"

namespace opponens::verify {
namespace {

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

void check_arm_solutions(const Grasp& grasp, const robot::RobotModel& robot, const Eigen::Isometry3d& X_RO,
                         double tolerance, Verdict& verdict) {
  const auto check = [&](const Eigen::VectorXd& q_arm, const Eigen::VectorXd& q_hand, const Eigen::Isometry3d& X_OH,
                         const std::string& name) {
    if (q_arm.size() != robot.arm().count || q_hand.size() != robot.hand().count || !q_arm.allFinite()) {
      verdict.fail(name + " has another number of joints than the robot, or one that is not finite");
      return;
    }
    Eigen::VectorXd q(robot.dof());
    q << q_arm, q_hand;
    if (!robot.within_limits(q, tolerance)) verdict.fail(name + " is outside the joint limits");
    check_palm(robot, q, robot.palm(), X_RO * X_OH, name, tolerance, verdict);
  };
  for (std::size_t i = 0; i < grasp.arm_solutions.size(); ++i) {
    const std::string name = "arm solution " + std::to_string(i);
    check(grasp.arm_solutions[i].q_pregrasp, grasp.q_pregrasp, grasp.X_OH_pregrasp, name + ", pre-grasp,");
    check(grasp.arm_solutions[i].q_grasp, grasp.q_grasp, grasp.X_OH, name + ", grasp,");
  }
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
  verdict.checked = check_quality(grasp.contacts, grasp.quality, grasp.certificate, verdict);
  return verdict;
}

}  // namespace opponens::verify
