// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/path.hpp"
#include "core/result.hpp"
#include "motion/contact_depth.hpp"
#include "motion/world.hpp"
#include "robot/collision.hpp"
#include "robot/robot_model.hpp"

namespace opponens::motion {

/// The world of a closing segment: joint limits, the checker that lets hand and object touch, and the depth to which
/// they may. All referred to; they must outlive the world.
World closing_world(const robot::CollisionChecker& closing, const robot::RobotModel& robot, double resolution,
                    const ContactLimit& contact = {});

struct ClosingSegment {
  Eigen::MatrixXd waypoints;               ///< [2 or 3 x d] rad, pre-grasp to grasp; empty when there is none
  std::optional<Eigen::VectorXd> invalid;  ///< [d] rad, a configuration that is in the way when there is none
};

/// The motion from pre-grasp to grasp: straight in joint space with arm and hand together; where that is not valid, the
/// arm first and then the hand. q_pregrasp is known to be valid. hand: its index range in q.
ClosingSegment closing_segment(const Eigen::VectorXd& q_pregrasp, const Eigen::VectorXd& q_grasp,
                               const PlanningGroup& hand, const World& closing);

/// A path that ends at a pre-grasp, with the closing segment after it: waypoint path.waypoints.rows() - 1 is the
/// pre-grasp. A Failure when no closing segment is valid.
Result<JointPath> append_closing_segment(const JointPath& path, const Eigen::VectorXd& q_grasp,
                                         const PlanningGroup& hand, const World& closing);

}  // namespace opponens::motion
