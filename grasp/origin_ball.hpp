// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// Of a set's scale: an origin this near to the boundary is on it.
constexpr double kTouching = 1e-10;

struct OriginBall {
  double radius;       ///< of the largest origin-centred ball in the set; negative: minus the distance to the set.
                       ///< Of a curved set a lower bound of either
  double upper;        ///< the true radius is at most this; equal to radius for a set of points that converged
  Vector6d direction;  ///< unit u with support h(u) = upper: the normal of the deciding facet, or of the separation
  bool inside;         ///< the origin is strictly inside: radius above the tolerance
  bool below = false;  ///< given up: upper < the search's at_least
  std::int64_t facets = 0;    ///< made on the way
  std::int64_t vertices = 0;  ///< support points used
  bool converged = true;      ///< false: upper and radius differ by more than was asked
};

struct BallSearch {
  double relative_gap = 0.0;  ///< (upper - radius) / upper at which to stop; > 0 for a curved set
  double at_least = -std::numeric_limits<double>::infinity();  ///< give up when the radius is known to be less
};

/// Ferrari and Canny's epsilon without the full hull. Wolfe's nearest point tells outside from inside and gives a first
/// simplex around the origin. Then the inner polytope (a simplicial complex kept as in beneath-beyond) grows at its
/// facet nearest to the origin by the support point of that facet's normal, until no support point lies beyond it: that
/// facet's offset is the radius. (In three dimensions this is the expanding polytope algorithm, van den Bergen 2001.)
/// Every support value h(u) bounds the radius from above, the nearest facet from below: what a curved set stops at, and
/// what lets a search give up. Points within 1e-11 scale of a facet's plane count as on it, so coplanar and duplicate
/// wrenches never make flat facets. The set must span R^6. Cost: O(6) per new facet, whose plane is a combination of
/// its two neighbours'.
OriginBall largest_origin_ball(const WrenchSpace& space, const BallSearch& search = {});

}  // namespace opponens::grasp
