// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

struct SupportBound {
  double value;        ///< h(direction): no origin-centred ball in the set is larger
  Vector6d direction;  ///< unit: the normal of a facet
};

/// A low upper bound of the radius of the largest origin-centred ball in the hull of the wrenches, which must hold the
/// origin inside: from the facet that the ray along `start` pierces to the one that the ray along that facet's normal
/// pierces, and on while it comes nearer to the origin. On the polar set this is the Frank-Wolfe method for the
/// largest norm: each step is a linear
/// programme of six rows, and it ends at a facet whose own normal pierces it, after about four. Stops early below
/// `enough`.
SupportBound descend_facets(const Matrix6Xd& wrenches, const Vector6d& start, double enough);

}  // namespace opponens::grasp
