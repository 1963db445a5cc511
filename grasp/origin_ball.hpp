// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// Of a set's scale: an origin this near to the boundary is on it.
constexpr double kTouching = 1e-10;

struct OriginBall {
  double radius;       ///< of the largest origin-centred ball in the set; negative: minus the distance to the set
  Vector6d direction;  ///< unit u with support h(u) = radius: the normal of the deciding facet, or of the separation
  bool inside;         ///< the origin is strictly inside: radius above the tolerance
  std::int64_t facets = 0;    ///< made on the way
  std::int64_t vertices = 0;  ///< support points used
  bool converged = true;      ///< false: a facet and the support function disagree by more than the tolerance
};

/// Ferrari and Canny's epsilon without the full hull. Wolfe's nearest point tells outside from inside and gives a first
/// simplex around the origin. Then the inner polytope (a simplicial complex kept as in beneath-beyond) grows at its
/// facet nearest to the origin by the support point of that facet's normal, until no support point lies beyond it: that
/// facet's offset is the radius. (In three dimensions this is the expanding polytope algorithm, van den Bergen 2001.)
/// Points within 1e-11 scale of a facet's plane count as on it, so coplanar and duplicate wrenches never make flat
/// facets. The set must span R^6. Cost: O(6) per new facet, whose plane is a combination of its two neighbours'.
OriginBall largest_origin_ball(const WrenchSpace& space);

}  // namespace opponens::grasp
