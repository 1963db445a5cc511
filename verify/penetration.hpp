// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "verify/solid.hpp"

namespace opponens::verify {

struct Depth {
  double attained;  ///< m, of a point that was found; 0 when none lies inside
  double bound;     ///< m, no point is deeper
};

/// How deep the surface of A reaches into the solid B: the largest distance from B's surface of a point of A's surface
/// that lies inside B. By branch and bound over balls around A's triangles and, below those, quarters of triangles: a
/// depth changes by no more than the distance between two points. Ends when the bound is below `enough`, or within 0.05
/// mm of the depth attained. 0 when B is open. X_BA: pose of A's frame in B's.
Depth penetration(const Solid& A, const Solid& B, const Eigen::Isometry3d& X_BA, double enough);

}  // namespace opponens::verify
