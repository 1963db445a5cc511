// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: MoveIt's text form of the bodies around a robot.

#include <filesystem>

#include "robot/scene.hpp"

namespace opponens::robot {

/// Whether a file is to be read as such: by its ending .scene.
bool is_scene_text(const std::filesystem::path& file);

/// Reads what MoveIt's PlanningScene::saveGeometryToStream writes, in the form of before and since MoveIt 1.1 (which
/// has a pose and subframes for each object). Shapes: box, sphere, cylinder and cone (radius, then length), mesh.
/// Throws InputError naming file, object and value.
Scene load_scene_text(const std::filesystem::path& file);

}  // namespace opponens::robot
