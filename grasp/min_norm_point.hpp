// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

struct MinNormPoint {
  Vector6d point;      ///< of the set, nearest to the origin
  double least;        ///< the distance is at least this: max over the steps of min_w x'w/|x|; <= 0: not separated
  Vector6d direction;  ///< unit -x/|x| of the step that gave least: u'w <= -least for all of the set
  Matrix6Xd corral;    ///< [6 x c], c <= 7: affinely independent points of the set whose hull holds it
};

/// Wolfe's algorithm (1976, doi:10.1007/BF01580381) with the support function as its oracle: finite, and the gap
/// |x| - min_w x'w/|x| bounds the error of the distance, so it stops at gap <= max(1e-13 scale, relative_gap |x|). Tens
/// of iterations. A curved set needs a relative gap to end early: there the algorithm only converges.
MinNormPoint min_norm_point(const WrenchSpace& space, double relative_gap = 0.0);

}  // namespace opponens::grasp
