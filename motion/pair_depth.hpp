// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "robot/collision.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::motion {

/// How deep two colliding bodies stick in each other at q, m: the greatest depth of points on either's surface inside
/// the other (ContactDepth, whose errors it has), 0 where none was found, as with open meshes. For messages: it builds
/// a distance for the pair, which takes milliseconds to seconds. q: [d] rad; pair: a link, and a link or scene body.
double pair_depth(const robot::RobotModel& robot, const robot::Scene& scene, const Eigen::VectorXd& q,
                  const robot::BodyPair& pair);

}  // namespace opponens::motion
