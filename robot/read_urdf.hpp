// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace opponens::robot {

enum class LinkGeometry { urdf_collision, visual };

/// Where the meshes of package://NAME/... lie. A package in neither is looked for above the URDF: a folder called NAME
/// that holds it, or stands beside one that does.
struct PackagePaths {
  std::map<std::string, std::filesystem::path> directories;  ///< by package name
  std::vector<std::filesystem::path> roots;                  ///< folders searched for a folder called NAME
};

/// What happens when a mesh is not there: an error, or the link goes without it and the description lists it.
enum class MissingMeshes { refuse, list };

struct UrdfSettings {
  PackagePaths packages;
  LinkGeometry geometry = LinkGeometry::urdf_collision;
  std::set<std::string> without_geometry;  ///< links whose shapes are not wanted (their meshes are not read)
  MissingMeshes missing_meshes = MissingMeshes::refuse;
};

/// Reads the tree of a URDF: links in topological order with siblings in the order of the file's joints; joint groups,
/// palm and surface points are left empty. What is ignored (inertia, transmissions, ...) is counted in the notes.
/// Throws InputError with one line that names the file and the element.
RobotDescription read_urdf(const std::filesystem::path& file, const UrdfSettings& settings);

}  // namespace opponens::robot
