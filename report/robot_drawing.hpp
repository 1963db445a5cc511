// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace opponens::report {

/// A complete SVG document of a robot at rest (joints at zero, clipped to their limits): arm and hand from two sides
/// with the arm's joints, where there is an arm; the hand from the palm's side with tips and contact points, from the
/// side of the thumb, and from the back with its joints. Names stand in the margins, joined to their places by lines;
/// axes are arrows in the joints' positive sense. Points that face away from the viewer are rings. tips and
/// contact_points: those to show, of the robot's own links (as in its description, or proposed ones).
std::string draw_robot(const robot::RobotModel& robot, const std::vector<robot::SurfacePoint>& tips,
                       const std::vector<robot::SurfacePoint>& contact_points);

}  // namespace opponens::report
