// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/finger_body.hpp"

namespace opponens::robot {

/// Up to three points of a body's flattest patch that faces `outward` (unit), far from each other, in a triangle where
/// the patch is wide enough, and away from the patch's rim: 10 mm where the patch is large enough, else 6, 3 or one
/// step of the grid (2 mm, or a 48th of the body).
std::vector<SurfaceHit> patch_points(const HandBody& body, const Eigen::Vector3d& outward);

}  // namespace opponens::robot
