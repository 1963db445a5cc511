// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "core/path.hpp"
#include "core/result.hpp"
#include "motion/contact_depth.hpp"
#include "motion/world.hpp"
#include "robot/collision.hpp"
#include "robot/robot_model.hpp"

namespace opponens::motion {

/// The world of a closing segment: joint limits; collision-free, or touching only where the grasp's contacts say so:
/// what collides at q is then a pair of a contact's link that `closing` leaves out, and no deeper than
/// contact.max_depth. Confirming asks everything else to keep contact.clearance throughout, and the depth too, or,
/// where that cannot be proven, at a tenth of the spacing. free_space: checker with everything; closing: checker that
/// leaves out hand-object pairs (it may leave out more links than have contacts, so one serves all grasps). All but the
/// contacts are referred to and must outlive the world.
World closing_world(const robot::CollisionChecker& free_space, const robot::CollisionChecker& closing,
                    const robot::RobotModel& robot, const std::vector<Contact>& contacts, double resolution,
                    const ContactLimit& contact = {});

struct ClosingSegment {
  Eigen::MatrixXd waypoints;               ///< [2 or 3 x d] rad, pre-grasp to grasp; empty when there is none
  std::optional<Eigen::VectorXd> invalid;  ///< [d] rad, a configuration that is in the way when there is none
};

/// The motion from pre-grasp to grasp (docs/deviations.md, 16): straight in joint space with arm and hand together;
/// where that is not valid, the arm first and then the hand. q_pregrasp is known to be valid. hand: its index range in
/// q.
ClosingSegment closing_segment(const Eigen::VectorXd& q_pregrasp, const Eigen::VectorXd& q_grasp,
                               const PlanningGroup& hand, const World& closing);

/// A path that ends at a pre-grasp, with the closing segment after it: waypoint path.waypoints.rows() - 1 is the
/// pre-grasp. A Failure when no closing segment is valid.
Result<JointPath> append_closing_segment(const JointPath& path, const Eigen::VectorXd& q_grasp,
                                         const PlanningGroup& hand, const World& closing);

}  // namespace opponens::motion
