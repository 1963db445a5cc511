// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Reads STL, OBJ or DAE through assimp, multiplied by scale (finite, not 0); duplicate vertices are merged exactly. A
/// negative factor mirrors, and the triangles still turn outward. Throws InputError when absent, unreadable, not finite
/// or without triangles.
std::shared_ptr<const TriangleMesh> load_mesh(const std::filesystem::path& file,
                                              const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

/// The same as written: vertices that are repeated, triangles without area, everything (for checks of the file).
TriangleMesh read_mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

/// Vertices whose coordinates are equal become one, numbered by their first appearance; triangles that then use a
/// vertex twice are dropped: they have no area and their other edges cancel, so the surface is the same.
TriangleMesh merge_equal_vertices(const TriangleMesh& mesh);

/// Surface of revolution about z through the profile points (radius, height) m, bottom to top; closed at both ends.
TriangleMesh revolve(const std::vector<std::pair<double, double>>& profile, int segments);

/// Triangulation of any shape (primitives with the given number of segments around).
TriangleMesh triangulate(const Shape& shape, int segments = 32);

/// Meshes of all geometries of a body joined, in the body frame.
TriangleMesh merge(const std::vector<Geometry>& geometry);

struct MassProperties {
  double volume;                   ///< m^3
  Eigen::Vector3d center_of_mass;  ///< m, uniform density
};
/// By the divergence theorem; meaningful for closed meshes (Mirtich 1996, doi:10.1080/10867651.1996.10487458).
MassProperties mass_properties(const TriangleMesh& mesh);

/// Every edge is run along as often in one direction as in the other: the surface has no boundary and encloses a
/// volume. (Merging equal vertices can pinch a closed surface so that four triangles meet in one edge; it still is
/// closed.)
bool is_closed(const TriangleMesh& mesh);

/// One vertex index per connected component.
std::vector<int> component_seeds(const TriangleMesh& mesh);

/// For each triangle the number of its component, in the order of component_seeds.
std::vector<int> component_of_triangles(const TriangleMesh& mesh);

/// The connected components as meshes of their own, in the order of component_seeds.
std::vector<TriangleMesh> components(const TriangleMesh& mesh);

/// Points on the surface in the body frame: every surface point lies within `spacing` (m) of one, and no two are nearer
/// than spacing / 2. Deterministic. Spheres and cylinder sides are sampled on the curved surface itself.
std::vector<Eigen::Vector3d> surface_samples(const Geometry& geometry, double spacing);

/// Appends the files that the meshes among the shapes were read from.
void append_mesh_files(const std::vector<Geometry>& geometry, std::vector<std::filesystem::path>& files);

}  // namespace opponens::robot
