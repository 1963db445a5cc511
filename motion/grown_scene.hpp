// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>

#include "robot/scene.hpp"

namespace opponens::motion {

/// The scene with every body but those in `except` larger by `margin` m on all sides: what is free in it keeps
/// that distance, so that a path checked at samples does not graze a body between them. Boxes keep their corners, so
/// they grow by up to sqrt(3) margin there; the vertices of a mesh move along its normals, so that its faces move out
/// by less than the margin where they meet at an angle (a cube's by 0.58 of it).
robot::Scene grown_scene(const robot::Scene& scene, double margin, const std::set<std::string>& except = {});

}  // namespace opponens::motion
