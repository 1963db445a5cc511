// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "robot/scene.hpp"

namespace opponens::experiments {

/// Scenes that no file describes, the robot's base near their origin but in the last: a large closed mesh that hands
/// get wholly into, thin plates (a solid of 1 mm and a surface without thickness), mugs, 200 bodies of 4 to 20 mm, and
/// bodies 1.5 km from the world's origin, the robot among them.
std::vector<robot::Scene> made_scenes();

}  // namespace opponens::experiments
