// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// What a search of precision grasps makes as large as it can.
enum class PrecisionGoal {
  min_weight,  ///< l*, FRoGGeR's; smooth enough for a quasi-Newton method, and grows before there is force closure
  epsilon,     ///< Ferrari and Canny's ball; its slope jumps from facet to facet
};

struct QualitySlope {
  double value = 0.0;  ///< l* times the number of wrenches (1 at best), or epsilon; below zero without force closure
  Matrix6Xd slope;     ///< d value / d wrenches [6 x N]
  bool known = false;  ///< false: the wrenches balance in no way, or do not span R^6; value and slope are zero
};

/// Value and slope of an L1 set's quality by its wrenches. l*: the dual of its linear programme. Epsilon: it is
/// u'w for every wrench w of the deciding facet with normal u, and u turns so that
/// d epsilon = sum_j a_j u'dw_j, with a the barycentric coordinates of the facet's point nearest to the origin; where
/// that facet is not unique, the slope is that of one of them.
QualitySlope quality_slope(const Matrix6Xd& wrenches, PrecisionGoal goal);

}  // namespace opponens::grasp
