// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/synergies.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// The way each joint closes the hand, [n] in [-1, 1]: the motion of the contact points that it moves along their own
/// normals (out of the pads, towards what they are to touch), over all their motion, at the middle of the joint limits.
/// About +-1 for a joint that bends a finger, about 0 for one that spreads it. hand: rooted at the palm (load_hand),
/// with contact points.
Eigen::VectorXd closing_joints(const robot::RobotModel& hand);

/// Boxes of a hand that is not held to synergies: one axis a joint. `group`, named "free joints", spans all of the
/// joint limits for joints that do not close the hand and the open half of them for those that do, from where they
/// close on until they touch; `pre_grasp` is the open hand.
struct FreeJoints {
  SynergyGroup group;
  SynergyBox pre_grasp;
};
FreeJoints free_joints(const robot::RobotModel& hand);

}  // namespace opponens::grasp
