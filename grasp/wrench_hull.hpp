// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

struct WrenchHull {
  double volume;
  double least_offset;  ///< least facet distance from the origin, negative when the origin is beyond a facet
};

/// Convex hull of points in R^6 by libqhull_r with merged facets, triangulated (options "Qt Q12"; never joggled).
/// nullopt when qhull cannot build it (a flat set). Thread-safe: each call owns its qhull context.
std::optional<WrenchHull> wrench_hull(const Matrix6Xd& points);

}  // namespace opponens::grasp
