// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "robot/geometry.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {

/// A rim of the surface: edges of one triangle that hang together.
struct MeshHole {
  int edges;
  double length;  ///< m, of all its edges
};

/// What is wrong with a mesh. Counts are of the mesh with equal vertices merged, except where they are about the file.
struct MeshReport {
  int vertices = 0;                       ///< that differ
  int triangles = 0;                      ///< as written
  Eigen::Vector3d extent;                 ///< m, of the bounding box
  int repeated_vertices = 0;              ///< as read: equal to an earlier one (of STL and OBJ always: one per corner)
  bool soup = false;                      ///< as read: no two of several triangles share a vertex
  int close_vertices = 0;                 ///< nearer to another than 1e-6 of the box's diagonal: a crack
  int degenerate_triangles = 0;           ///< without area: a corner twice, or a height below 1e-9 of the diagonal
  int duplicate_triangles = 0;            ///< of the same three vertices as an earlier one, either way round
  std::vector<MeshHole> holes;            ///< longest first
  int nonmanifold_edges = 0;              ///< of three and more triangles
  int nonmanifold_vertices = 0;           ///< in which parts meet that share no edge there
  int flipped_triangles = 0;              ///< against the majority of the patch they hang in
  bool orientable = true;                 ///< false: some patch has no two sides
  int components = 0;                     ///< parts that share no vertex
  int open_components = 0;                ///< of them without an inside: holes, or not oriented alike
  int cavities = 0;                       ///< closed parts turned inwards inside of another
  int inside_out = 0;                     ///< closed parts turned inwards that are no cavity
  std::optional<int> self_intersections;  ///< pairs of triangles; empty: not asked for
  std::vector<double> likely_scales;      ///< when the size is unusual: factors that would make it a usual one

  bool closed() const { return open_components == 0; }  ///< every part encloses a volume
};

/// Checks a mesh as read_mesh gives it. Cost O(F log F); the self-intersections (exact predicates of CGAL) are a few
/// times dearer and asked for with the flag. Of an unusual size is what is longer than 20 m or shorter than 2 mm.
MeshReport check_mesh(const TriangleMesh& written, bool self_intersections = false);

/// What of it is a defect, a few words each; empty: none. Repeated vertices and soup are none by themselves (every STL
/// file is one): loading merges equal vertices.
std::vector<std::string> defects(const MeshReport& report);

/// The defects of the meshes of a scene's bodies, a sentence each; a mesh that several bodies share once.
std::vector<std::string> mesh_warnings(const Scene& scene);

}  // namespace opponens::robot
