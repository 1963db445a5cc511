// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Reads STL, OBJ or DAE through assimp, multiplied by scale; duplicate vertices are merged exactly.
/// Throws InputError when absent, unreadable or without triangles.
std::shared_ptr<const TriangleMesh> load_mesh(const std::filesystem::path& file,
                                              const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

/// Surface of revolution about z through the profile points (radius, height) m, bottom to top; closed at both ends.
TriangleMesh revolve(const std::vector<std::pair<double, double>>& profile, int segments);

/// Triangulation of any shape (primitives with the given number of segments around).
TriangleMesh triangulate(const Shape& shape, int segments = 32);

/// Meshes of all geometries of a body joined, in the body frame.
TriangleMesh merge(const std::vector<Geometry>& geometry);

struct MassProperties {
  double volume;                  ///< m^3
  Eigen::Vector3d center_of_mass; ///< m, uniform density
};
/// By the divergence theorem; meaningful for closed meshes (Mirtich 1996, doi:10.1080/10867651.1996.10487458).
MassProperties mass_properties(const TriangleMesh& mesh);

/// Every edge is shared by exactly two triangles in opposite directions.
bool is_closed(const TriangleMesh& mesh);

/// One vertex index per connected component.
std::vector<int> component_seeds(const TriangleMesh& mesh);

}  // namespace opponens::robot
