// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// The part of a hand and object that closing needs; refers to the caller's values.
struct ClosingScene {
  const robot::RobotModel& hand;
  const HandSurface& surface;
  const GraspTarget& target;
  const SynergyBox& box;             ///< of the group
  const Eigen::VectorXd& direction;  ///< [n] rad, largest entry 1: the group's closing direction
};

/// The group's closing direction in joint space: from the pre-grasp box's centre to the group's, along the group's
/// synergies; the plain difference of the centres when these are orthogonal to it; scaled so that the largest joint
/// moves by 1 rad. Zero when the centres agree.
Eigen::VectorXd closing_direction(const SynergyBox& group, const SynergyBox& pre_grasp);

struct HandPose {
  Eigen::Isometry3d X_OH = Eigen::Isometry3d::Identity();
  Eigen::VectorXd q;  ///< [n] rad
};

/// Brings a hand near an object into touch with it. The palm draws back along its approach direction until it is out of
/// the object; fingers that still penetrate open against the closing direction or, where that does not free them, by
/// the least joint motion that does; the hand advances by at most 2 cm until it touches. Then finger by finger the
/// joints move along the closing direction until the finger touches (or, when that does not reach the object, along the
/// synergy combination that brings the finger's contact points nearer). A joint at its limit stays there. Where a link
/// touches, the joints that move it stop, and the joints beyond it go on. A finger that meets nothing stays where it
/// was. Contact is exact (MeshDistance) to 0.2 mm at the hand's sampled points. nullopt: the hand cannot be freed from
/// the object.
std::optional<HandPose> close_hand(const ClosingScene& scene, const HandPose& start);

/// Contacts of a posture: every contact point of the hand that is nearer than tolerance to the surface, and for every
/// other link that touches, the nearest of its sampled points. p_OC: nearest surface point; n_O: into the object.
std::vector<Contact> find_contacts(const ClosingScene& scene, const HandPose& pose, double tolerance, double mu);

}  // namespace opponens::grasp
