// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/given_grasps.hpp"

#include <cstdio>
#include <limits>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"
#include "grasp/certificate.hpp"
#include "grasp/grasp_check.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

constexpr double kLimitTolerance = 1e-6;  // rad: postures come with eight digits

std::string beyond_limits(const robot::RobotModel& hand, const Eigen::VectorXd& q) {
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    if (q[j] >= hand.lower()[j] - kLimitTolerance && q[j] <= hand.upper()[j] + kLimitTolerance) continue;
    char text[160];
    std::snprintf(text, sizeof text, "outside the joint limits: %s at %.4f rad, limits %.4f to %.4f",
                  hand.joint_names()[static_cast<std::size_t>(j)].c_str(), q[j], hand.lower()[j], hand.upper()[j]);
    return text;
  }
  return {};
}

GivenGrasp check_one(const GivenWorld& world, const HandPose& given, const Accept& accept) {
  const SearchSettings& settings = world.settings;
  const auto& [hand, target, surface, checkers] = world.search;
  if (std::string reason = beyond_limits(hand, given.q); !reason.empty()) return {std::nullopt, reason};
  const HandPose posture{given.X_OH, hand.clip(given.q)};
  const SynergyGroup& group = world.groups[nearest_group(world.groups, posture.q)];
  const Eigen::VectorXd direction = closing_direction(group.box, world.pre_grasp);
  const ClosingScene scene{hand, surface, target, group.box, direction};
  Grasp grasp;
  grasp.contacts = find_contacts(scene, posture, settings.contact_tolerance, settings.mu);
  if (grasp.contacts.size() < 3) return {std::nullopt, "fewer than three contacts"};
  grasp.quality = evaluate(grasp.contacts, default_convention(target, settings.mu, settings.edges));
  if (!grasp.quality.force_closure()) return {std::nullopt, "not force closure"};
  if (!grasp.quality.epsilon) return {std::nullopt, "epsilon did not converge"};
  const GraspLimits limits =
      grasp_limits(hand, links_of(grasp.contacts), settings.max_penetration, settings.clearance_pregrasp);
  if (std::string fault = posture_fault(scene, checkers, posture, limits); !fault.empty()) {
    return {std::nullopt, fault};
  }
  const auto pregrasp = find_pregrasp(scene, checkers, world.pre_grasp, posture, limits);
  if (!pregrasp) return {std::nullopt, "no clear pre-grasp"};
  grasp.q_grasp = posture.q;
  grasp.X_OH = posture.X_OH;
  grasp.q_pregrasp = pregrasp->q;
  grasp.X_OH_pregrasp = pregrasp->X_OH;
  grasp.origin = GraspOrigin::imported;
  describe_along(group, settings.slack_bound, grasp);
  grasp.certificate = certify(grasp.contacts, grasp.quality);
  if (!grasp.certificate) return {std::nullopt, "closure cannot be certified"};
  std::string reason = accept ? accept(grasp) : std::string();
  if (!reason.empty()) return {std::nullopt, std::move(reason)};
  return {std::move(grasp), {}};
}

}  // namespace

void describe_along(const SynergyGroup& group, double slack_bound, Grasp& grasp) {
  const SynergyBox& box = group.box;
  grasp.group = group.name;
  grasp.coefficients = analysis::coordinates(box, grasp.q_grasp).cwiseMax(-box.half_width).cwiseMin(box.half_width);
  grasp.slack = grasp.q_grasp - analysis::configuration(box, grasp.coefficients);
  grasp.synergy_grasp = grasp.slack.norm() <= slack_bound;
}

std::size_t nearest_group(const std::vector<SynergyGroup>& groups, const Eigen::VectorXd& q) {
  require(!groups.empty(), "nearest_group: there are no groups");
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double slack = (q - analysis::project(groups[i].box, q)).norm();
    if (slack >= least) continue;
    least = slack;
    nearest = i;
  }
  return nearest;
}

std::vector<GivenGrasp> check_given(const GivenWorld& world, const std::vector<HandPose>& postures,
                                    const Accept& accept) {
  validate(world.settings);
  for (const HandPose& posture : postures) {
    require(posture.q.size() == world.search.hand.dof() && posture.q.allFinite() && posture.X_OH.matrix().allFinite(),
            "check_given: a posture is not finite, or not of this hand's joints");
  }
  require(!world.groups.empty(), "check_given: there are no groups");
  std::vector<GivenGrasp> results;
  results.reserve(postures.size());
  for (const HandPose& posture : postures) results.push_back(check_one(world, posture, accept));
  return results;
}

}  // namespace opponens::grasp
