// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// FRoGGeR's conventions in this project's terms.
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "grasp/tip_contact.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens {

/// FRoGGeR's cone edges lie along the projection of (1.2, 2.3, 3.4) on the tangent plane and across it; ours along
/// n x X and across it. With four edges these are the same forces once the object's frame is turned so that
/// (1.2, 2.3, 3.4) points along X, and turning all wrenches moves neither l* nor epsilon. So the object is turned by
/// this rotation R_AO from their frame O to our frame A, and everything after follows the library's own rule.
Eigen::Matrix3d tangent_rotation();

/// The body "object": their mesh in frame A, standing in a world whose axes are their object frame's; and the body
/// "table" with its top at table_z, when asked for.
robot::Scene frogger_scene(const std::filesystem::path& mesh, double table_z, bool table);

/// Unit force, four edges, unscaled torque about the mesh's origin, L1.
QualityConvention frogger_convention(double mu, int edges);

/// The joint range that FRoGGeR allows: the middle 90 % of the manufacturer's, flexion at least 0.15 rad, the thumb's
/// first two joints at least 0.4 and 0.5 rad (core/robots/robots.py of its repository).
SynergyBox frogger_joint_box(const robot::RobotModel& hand);

/// Which normal a contact gets.
enum class NormalRule {
  distance,  ///< against the gradient of the distance at the tip (FRoGGeR's)
  face,      ///< of the triangle nearest to it
};

struct Posture {
  Eigen::Isometry3d X_OH = Eigen::Isometry3d::Identity();  ///< palm in frame A
  Eigen::VectorXd q;
};

/// The posture's contacts, one per tip. A fixed point touches where it is (FRoGGeR's), a ball in the nearest point of
/// the object.
std::vector<Contact> tip_contacts(const robot::RobotModel& hand, const grasp::HandSurface& surface,
                                  const grasp::GraspTarget& target, grasp::TipModel model, const Posture& posture,
                                  NormalRule rule, double mu);

/// Largest distance of a tip's point (fixed_point) or ball to the surface, m, either sign.
double largest_gap(const robot::RobotModel& hand, const grasp::HandSurface& surface, const grasp::GraspTarget& target,
                   grasp::TipModel model, const Posture& posture);

}  // namespace opponens
