// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opponens {

struct CgalHull {
  double least_offset;  ///< least distance of a facet's plane from the origin, negative when the origin is beyond one
  int facets;
};

/// The convex hull in R^6 by CGAL's dD triangulation with exact predicates: the infinite cells are the hull's facets.
CgalHull cgal_hull(const Eigen::Matrix<double, 6, Eigen::Dynamic>& points);

}  // namespace opponens
