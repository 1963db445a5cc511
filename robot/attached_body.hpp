// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

/// The robot holding a body: one more link, named like the body and fixed to `link` at X_LB, with the body's shapes. It
/// may touch what is rigidly joined to `link`, and the touch_links (the fingers that hold it); everything else, other
/// links and the scene, collides with it as with any link. A value like the robot it was made from, so whatever checks
/// robots needs to know nothing of held bodies, and to let go is to use the old value again. Throws
/// std::invalid_argument when a link is unknown or the body's name is taken.
RobotDescription attach_body(const RobotDescription& robot, const SceneBody& body, const std::string& link,
                             const Eigen::Isometry3d& X_LB, const std::vector<std::string>& touch_links);

/// The scene without a body, which the robot has picked up: no longer its object to grasp nor its support either.
/// Throws std::invalid_argument when there is none of that name.
Scene without_body(const Scene& scene, const std::string& body);

}  // namespace opponens::robot
