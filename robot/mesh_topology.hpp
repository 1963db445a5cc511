// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: how the triangles of a mesh hang together. Vertices are those of the mesh, so merge equal ones
// before asking.

#include <utility>
#include <vector>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// An edge and the triangles that have it.
struct MeshEdge {
  int low, high;               ///< vertices, low < high
  std::vector<int> triangles;  ///< in ascending order
  int forward = 0;             ///< how many of them run along it from low to high
};

/// Every edge once, by (low, high).
std::vector<MeshEdge> mesh_edges(const TriangleMesh& mesh);

/// Orientation within the patches of triangles that hang together by edges of exactly two triangles.
struct PatchOrientation {
  std::vector<bool> turned;  ///< [F] of those against the majority of their patch, by area
  int turned_count = 0;
  bool orientable = true;  ///< false: some patch has no consistent orientation (a Moebius strip)
};
PatchOrientation patch_orientation(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges);

/// Vertices in which parts of the surface meet that share no edge there.
int nonmanifold_vertices(const TriangleMesh& mesh);

/// For every vertex the first one (in order) that lies nearer than the tolerance (m), itself if none.
std::vector<int> first_close_vertex(const TriangleMesh& mesh, double tolerance);

/// Triangles of the same vertices as another: one of them stays. Two that run opposite ways are a fin, a double sheet
/// without volume; both go when all fins together are less than a thousandth of the surface (else it is a surface of
/// sheets, of which one side has to stay).
struct RepeatedTriangles {
  std::vector<bool> kept;  ///< [F]
  int fins = 0;            ///< pairs of which none stays
  int dropped = 0;         ///< the others that go
};
RepeatedTriangles repeated_triangles(const TriangleMesh& mesh);

/// What a component of a mesh is, in the order of component_seeds.
enum class ComponentKind {
  open,        ///< has a boundary, or its triangles are not oriented alike
  solid,       ///< closed, with its outside outwards
  cavity,      ///< closed, turned inwards, inside of an odd number of other closed components
  inside_out,  ///< closed, turned inwards, and no cavity
};
std::vector<ComponentKind> component_kinds(const TriangleMesh& mesh);

/// Runs the triangles the other way round.
void turn_triangle(TriangleMesh& mesh, Eigen::Index triangle);

}  // namespace opponens::robot
