// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion/smooth.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::motion {

/// For `smooth`: one distance for each link that q moves and that has a shape, from the scene's bodies: that of its
/// nearest ball, with the link covered by a few balls (sphere trees of 12 leaves at most, so a link counts as larger
/// than it is by up to some centimetres), to exact signed distances of the bodies: closed forms, MeshDistance of
/// meshes. No more than `reach` (m): further away the distance is reach and its derivative zero, so few pairs cost
/// anything. The robot is not held against itself. A guide, not a verdict. robot is referred to and must outlive the
/// result.
Clearances scene_clearances(const robot::RobotModel& robot, const robot::Scene& scene, double reach);

}  // namespace opponens::motion
