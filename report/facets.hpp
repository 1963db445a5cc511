// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/geometry.hpp"

namespace opponens::report {

/// A flat convex piece of a surface.
struct Facet {
  std::vector<Eigen::Vector3d> corners;               ///< m, counter-clockwise seen from outside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outward
  int paint = 0;                                      ///< index into the picture's paints
};

/// How finely a shape is drawn.
struct FacetDetail {
  int around = 20;          ///< flat strips around a cylinder or sphere
  int max_triangles = 400;  ///< of a mesh; finer ones are simplified by vertex clustering
};

/// The surface of a geometry in its body's frame. A mesh that is inside out (negative volume) is turned.
std::vector<Facet> facets(const robot::Geometry& geometry, int paint, const FacetDetail& detail);

/// The mesh with vertices merged on a grid (their mean stands for each cell) coarse enough that at most max_triangles
/// are left (Rossignac and Borrel 1993, doi:10.1007/978-3-642-78114-8_29). Returned as it is when small enough.
robot::TriangleMesh simplified(const robot::TriangleMesh& mesh, int max_triangles);

/// Appends moved copies of facets.
void append(std::vector<Facet>& out, const std::vector<Facet>& facets, const Eigen::Isometry3d& X_WB);

/// The facets turned to the viewer, ordered so that each may be painted over the ones before it: a binary space
/// partition that cuts facets where their planes cross (Fuchs, Kedem and Naylor 1980, doi:10.1145/965105.807481).
/// Orthographic view along -toward_viewer (unit). Deterministic. Cost about O(F log F), O(F^2) at worst.
std::vector<Facet> back_to_front(std::vector<Facet> facets, const Eigen::Vector3d& toward_viewer);

}  // namespace opponens::report
