// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/grasp.hpp"
#include "motion/contact_depth.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::motion {

/// Arm solutions kept per grasp.
inline constexpr int kMaxArmSolutions = 4;

/// Lines 6-7 of Algorithm 1 for one grasp: inverse kinematics of pre-grasp and grasp on the same branch, limits, and
/// collision with scene and self at the pre-grasp and along the closing segment (there the links of the grasp's
/// contacts may touch the object, see closing_world). Branches of the two poses are paired by the least joint motion
/// between them (where the solver does not find all branches, it looks for the pre-grasp's beside the grasp's); of
/// solutions that differ by whole turns the one nearest to zero is kept. Fills grasp.arm_solutions with at most
/// kMaxArmSolutions, least motion first. Returns an empty string when at least one solution is left, else the reason of
/// the solution that came furthest: "no inverse kinematics", "outside the joint limits" (of the hand: the arm's
/// solutions are inside), "pre-grasp in collision: LINK-BODY", "closing segment in collision: LINK-BODY" or "closing
/// segment too deep in the object", "closing segment nearer to something than the clearance"; arm_solutions is empty
/// then. free_space: checker with everything; closing: checker that leaves hand-object pairs out. X_RO: object in the
/// robot's root. resolution: rad, spacing of checked configurations. Thread-safe.
std::string reach(Grasp& grasp, const robot::RobotModel& robot, const robot::InverseKinematics& kinematics,
                  const Eigen::Isometry3d& X_RO, const robot::CollisionChecker& free_space,
                  const robot::CollisionChecker& closing, double resolution, const ContactLimit& contact = {});

/// A whole configuration [d] from its arm and hand parts.
Eigen::VectorXd join(const robot::RobotModel& robot, const Eigen::VectorXd& q_arm, const Eigen::VectorXd& q_hand);

}  // namespace opponens::motion
