// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "core/rng.hpp"
#include "robot/mesh_distance.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

void validate(const GraspNoise& noise);  ///< throws std::invalid_argument naming field, value, constraint

/// m, that a contact follows a displaced object; one that would have to go farther is lost.
inline constexpr double kFollow = 0.02;

/// The contacts of a grasp found again with the object displaced to X_OD and friction changed by `friction` (never
/// below 0), in D. See robust_quality for the rule; those that are lost are left out.
std::vector<Contact> disturbed_contacts(const robot::RobotModel& hand, const robot::MeshDistance& object,
                                        const Grasp& grasp, const Eigen::Isometry3d& X_OD, double friction);

/// Quality of a grasp when the object is not where it was thought to be, and not as rough: noise.samples times the
/// object is shifted and turned about the convention's origin (its centre of mass), the friction of all contacts
/// changes by one error (never below 0), and the contacts are found again with the hand where it was planned. A contact
/// moves straight along the way its point goes when the fingers close from pre-grasp to grasp (which may be back: a
/// finger that meets the object early stops early), or along its normal where closing does not carry it into the object
/// (the palm; a point that closing moves at more than 78 degrees to its normal). Where the line meets the surface
/// within kFollow, there is the contact, with the surface's normal; else it is lost. What is left is judged under the
/// grasp's own convention. The object does not give way, no finger bends, and other links than those of the contacts
/// touch nothing: an estimate of what survives, not a simulation. object: of the grasped body, in O. hand: rooted at
/// the palm. Cost: samples times one quality and some four distance queries per contact. Draws 7 normal numbers a
/// sample.
RobustQuality robust_quality(const robot::RobotModel& hand, const robot::MeshDistance& object, const Grasp& grasp,
                             const GraspNoise& noise, Rng& rng);

}  // namespace opponens::grasp
