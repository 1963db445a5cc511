// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "robot/geometry.hpp"

namespace opponens::robot {

/// Vertices nearer than this share of the bounding box's diagonal are one to repair_mesh, and a crack to check_mesh.
inline constexpr double kCloseVertices = 1e-6;

/// Pairs of triangles of the surface that share more points than the vertices or the edge they have in common (exact
/// predicates). Equal vertices have to be merged; triangles twice are not counted here.
int count_self_intersections(const TriangleMesh& mesh);

struct RepairedMesh {
  TriangleMesh mesh;
  std::vector<std::string> changes;  ///< what was done, a few words each; empty: nothing
};

/// Makes an oriented manifold surface of a mesh as written, and closes its holes: vertices that are equal or close are
/// merged, triangles without area and double sheets dropped, of triangles twice one kept, triangles turned to agree
/// with their neighbours, non-manifold places cut open, borders that coincide joined, holes filled by triangles (CGAL's
/// least area), parts inside out turned. Self-intersections stay. Shapes with a wide opening (a mug without its inside)
/// get a lid: look at what surface_change says. Failure when nothing is left of the mesh.
Result<RepairedMesh> repair_mesh(const TriangleMesh& written);

/// A mesh of about that many triangles, by edge collapses that keep volume and boundary (Lindstrom and Turk 1998,
/// doi:10.1109/VISUAL.1998.745314). The mesh must be an oriented manifold, as repair_mesh makes it; else Failure. It
/// may become smaller somewhere: surface_change says by how much at most.
Result<TriangleMesh> simplify_mesh(const TriangleMesh& mesh, int triangles);

/// How far two surfaces are apart, m. Measured at samples; every point of the surfaces lies within `spacing` of one, so
/// no value at any point exceeds the one here by more than the spacing.
struct SurfaceChange {
  double from_before;  ///< largest distance of a sample of the surface before to the surface after
  double from_after;   ///< the other way round
  double shrunk;       ///< deepest that a sample of the surface before lies outside of the solid after; 0 when
                       ///< it is not closed, since then it has no outside
  double spacing;
  double bound() const { return std::max(from_before, from_after) + spacing; }  ///< of the Hausdorff distance
  double shrunk_bound() const { return shrunk + spacing; }  ///< no point of the solid before is further outside
};
SurfaceChange surface_change(const TriangleMesh& before, const TriangleMesh& after);

}  // namespace opponens::robot
