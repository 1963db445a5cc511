// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/facet_descent.hpp"

#include <limits>

#include "grasp/six_row_simplex.hpp"

namespace opponens::grasp {

SupportBound descend_facets(const Matrix6Xd& wrenches, const Vector6d& start, double enough) {
  constexpr int kMaxSteps = 20;
  const double scale = wrenches.colwise().norm().maxCoeff();
  const Matrix6Xd points = wrenches / scale;
  SupportBound best{std::numeric_limits<double>::infinity(), start.normalized()};
  Vector6d ray = best.direction;
  for (int step = 0; step < kMaxSteps && best.value >= enough; ++step) {
    SixRowSimplex simplex(points, ray);
    if (!simplex.feasible().value_or(false) || !simplex.optimize()) break;
    ray = simplex.dual().normalized();
    const double value = (ray.transpose() * wrenches).maxCoeff();  // a bound whatever the programme's rounding
    if (value >= best.value) break;
    best = {value, ray};
  }
  return best;
}

}  // namespace opponens::grasp
