// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grasp/close_hand.hpp"
#include "robot/collision.hpp"

namespace opponens::grasp {

/// Per link, least signed distance of its surface points to the object, m: exact (MeshDistance), at most horizon.
std::vector<double> link_object_distances(const ClosingScene& scene, const HandPose& pose, double horizon);

/// The same seen from the object: per link, the least signed distance of the object's surface points to it, m; at most
/// horizon. Sees edges and corners of the object that slip between the hand's own points.
std::vector<double> object_link_distances(const ClosingScene& scene, const HandPose& pose, double horizon);

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

/// What a grasp is held to.
struct GraspLimits {
  std::vector<bool> touching;  ///< per link: has a contact; other links keep clear of the object by 0.5 mm
  double max_penetration;      ///< m, of touching links
  double clearance_pregrasp;   ///< m
};

/// Links with contacts may touch, and penetrate by max_penetration, m, less what may lie between the 2.5 mm apart
/// points that a verdict looks at (a ball of 12 mm reaches 0.065 mm beyond the chord of two) and its samples of a
/// motion: 0.1 mm, at most half of it. `verify` holds a grasp's whole motion to the bound itself.
GraspLimits grasp_limits(const robot::RobotModel& hand, const std::vector<std::string>& touching,
                         double max_penetration, double clearance_pregrasp);
std::vector<std::string> links_of(const std::vector<Contact>& contacts);

/// Why a posture is no grasp, or an empty string: penetration beyond the bound, a link without a contact nearer than
/// 0.5 mm to the object, support or obstacle nearer than 1 mm, fingers nearer than 0.5 mm to each other, or a collision
/// by the collision truth. Obstacles and colliding pairs are named: "too near to an obstacle: NAME", "hand in
/// collision: A-B".
std::string posture_fault(const ClosingScene& scene, const HandCheckers& checkers, const HandPose& pose,
                          const GraspLimits& limits);

/// Pre-grasp of a closed hand: fingers opened towards the pre-grasp box and hand drawn back along its approach
/// direction, by the least of a fixed ladder of amounts for which the hand keeps its clearance from the object,
/// collides with nothing, and can move straight (in palm position and joints) to the grasp: at twelve samples the
/// hand's points keep what posture_fault asks of them, at every third the collision truth is asked too.
std::optional<HandPose> find_pregrasp(const ClosingScene& scene, const HandCheckers& checkers,
                                      const SynergyBox& pre_grasp, const HandPose& grasp, const GraspLimits& limits);

}  // namespace opponens::grasp
