// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grasp/close_hand.hpp"
#include "robot/collision.hpp"

namespace opponens::grasp {

/// Which of the hand's sampled points a question looks at.
enum class Density { medium, dense };

/// Least signed distance of the hand's sampled points to the object, m; exact (MeshDistance) below `exact_below`, from
/// the grid above it.
double hand_object_distance(const ClosingScene& scene, const HandPose& pose, Density density, double exact_below);

/// Deepest object surface point inside a hand link, as a signed distance (negative: inside), m; at most `horizon`. Sees
/// the edges and corners of an object that slip between the hand's own points.
double object_hand_distance(const ClosingScene& scene, const HandPose& pose, double horizon);

/// Least distance between points of different links that the model does not allow to touch, m; at most `horizon`.
double self_distance(const ClosingScene& scene, const HandPose& pose, double horizon);

/// Least distance of the hand's points to support and obstacles, m; at most `horizon`.
double obstacle_distance(const ClosingScene& scene, const HandPose& pose, double horizon);

/// Collision checkers of the free-flying hand: with the object, and with the object left out.
struct HandCheckers {
  robot::CollisionChecker apart;     ///< every pair
  robot::CollisionChecker touching;  ///< hand-object pairs not checked
};
HandCheckers hand_checkers(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object);

/// Why a posture is no grasp, or an empty string: penetration beyond the bound, support or obstacle nearer than 1 mm,
/// fingers nearer than 0.5 mm to each other, or a collision by the collision truth.
std::string posture_fault(const ClosingScene& scene, const HandCheckers& checkers, const HandPose& pose,
                          double max_penetration);

/// Pre-grasp of a closed hand: fingers opened towards the pre-grasp box and hand drawn back along its approach
/// direction, by the least of a fixed ladder of amounts for which the hand keeps clearance from the object, collides
/// with nothing, and can move straight to the grasp without penetrating anything by more than max_penetration.
std::optional<HandPose> find_pregrasp(const ClosingScene& scene, const HandCheckers& checkers,
                                      const SynergyBox& pre_grasp, const HandPose& grasp, double clearance,
                                      double max_penetration);

}  // namespace opponens::grasp
