// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"
#include "verify/closure.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {

struct GraspCheckSettings {
  double tolerance = 1e-6;           ///< rad, m or 1: of stored numbers that follow from each other
  double slack_bound = 0.3;          ///< rad, 2-norm of the slack of a synergy grasp
  double contact_distance = 0.0025;  ///< m, of a contact from the object's and from its link's surface
  double normal_angle = 0.35;        ///< rad, of a contact normal from the object's surface normal nearby
};

/// What a stored grasp is checked against.
struct GraspContext {
  const SynergyBox* box;           ///< of the grasp's group
  const robot::RobotModel* hand;   ///< rooted at the palm
  const robot::SceneBody* object;  ///< body frame = O
};

/// Re-checks a stored grasp without the code that found it: orthonormal poses; joint limits of grasp and pre-grasp;
/// slack = q_grasp - scale .* (center + axes c), coefficients inside the box and, for a synergy grasp, the slack's
/// bound; contacts with unit normals on the surfaces of object and link, normals along the object's; and force closure,
/// certificate, epsilon and l* of the contact model (check_quality). A grasp without a certificate passes: stores of
/// before have none. No collision: see paths.hpp.
Verdict check_grasp(const Grasp& grasp, const GraspContext& context, const GraspCheckSettings& settings = {});

/// Whether each stored arm solution lies in the limits and puts the palm at X_OH_pregrasp and at X_OH, to `tolerance`
/// (m and rad). robot: arm and hand; X_RO: object in the robot's root.
void check_arm_solutions(const Grasp& grasp, const robot::RobotModel& robot, const Eigen::Isometry3d& X_RO,
                         double tolerance, Verdict& verdict);

}  // namespace opponens::verify
