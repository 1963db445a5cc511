// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "grasp/close_hand.hpp"
#include "grasp/grasp_search.hpp"

namespace opponens::grasp {

/// Says of a grasp what it is along a group's synergies: sets group, coefficients (clamped to the box), slack and
/// whether its norm is within slack_bound, rad. Needs q_grasp.
void describe_along(const SynergyGroup& group, double slack_bound, Grasp& grasp);

/// The group whose box is nearest to q, by the norm of the slack, rad. q: [n] rad; groups: at least one.
std::size_t nearest_group(const std::vector<SynergyGroup>& groups, const Eigen::VectorXd& q);

/// What given grasps are held to: refers to the caller's values.
struct GivenWorld {
  const SearchWorld& search;
  const std::vector<SynergyGroup>& groups;  ///< of which each grasp gets the nearest
  const SynergyBox& pre_grasp;
  const SearchSettings& settings;
};

struct GivenGrasp {
  std::optional<Grasp> grasp;
  std::string reason;  ///< when it is refused
};

/// Holds postures that were made elsewhere to all that the search asks of its own: joint limits, at least three
/// contacts within contact_tolerance, force closure, penetration and clearances (posture_fault), a pre-grasp
/// (find_pregrasp) and `accept`. The postures are taken as they are. The grasps' origin is `imported`; results in the
/// order of the postures. Throws std::invalid_argument when a posture is not finite or of another hand.
std::vector<GivenGrasp> check_given(const GivenWorld& world, const std::vector<HandPose>& postures,
                                    const Accept& accept = {});

}  // namespace opponens::grasp
