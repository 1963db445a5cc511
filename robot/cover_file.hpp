// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "robot/mesh_cover.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

/// The same description with the covers of all its meshes, which save the collision checker making them. They are read
/// from the folder where they were made before, else made and written there. The folder only saves time:
/// - A file belongs to a mesh by the SHA-256 of its vertices and triangles, the tree's settings and the format's
///   version, which its name is and which it holds, besides the SHA-256 of all its bytes. A file that is damaged, cut
///   off, another's, or written by another version or kind of processor counts as absent and is replaced.
/// - A folder that cannot be made, read or written counts as empty.
/// - Files are written aside and renamed, so that several processes may share the folder. Everything in it may be
///   deleted at any time.
/// An empty path: covers are made, and neither read nor written. Meshes that several links share stay shared.
RobotDescription with_covers(RobotDescription robot, const std::filesystem::path& folder);
Scene with_covers(Scene scene, const std::filesystem::path& folder);

}  // namespace opponens::robot
