// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/precision_quality.hpp"

#include <vector>

#include <Eigen/Dense>

#include "grasp/min_norm_point.hpp"
#include "grasp/min_weight.hpp"
#include "grasp/origin_ball.hpp"

namespace opponens::grasp {
namespace {

constexpr double kOnFacet = 1e-9;        // of the set's scale
constexpr double kSpanTolerance = 1e-9;  // relative to the largest singular value

QualitySlope min_weight_slope(const Matrix6Xd& wrenches) {
  const MinWeight solution = min_weight(wrenches);
  if (solution.state != MinWeight::State::optimal) return {0.0, Matrix6Xd::Zero(6, wrenches.cols()), false};
  const double count = static_cast<double>(wrenches.cols());
  return {count * solution.value, count * min_weight_gradient(solution), true};
}

QualitySlope epsilon_slope(const Matrix6Xd& wrenches) {
  QualitySlope result{0.0, Matrix6Xd::Zero(6, wrenches.cols()), false};
  if (wrench_rank(wrenches, kSpanTolerance) < 6) return result;
  const WrenchSpace space(wrenches, 1, WrenchNorm::l1);
  const OriginBall ball = largest_origin_ball(space);
  if (!ball.converged) return result;
  std::vector<Eigen::Index> facet;
  for (Eigen::Index j = 0; j < wrenches.cols(); ++j) {
    if (ball.direction.dot(wrenches.col(j)) >= ball.radius - kOnFacet * space.scale()) facet.push_back(j);
  }
  const Matrix6Xd on_facet = wrenches(Eigen::all, facet);
  const MinNormPoint nearest = min_norm_point(WrenchSpace(on_facet, 1, WrenchNorm::l1));
  Eigen::MatrixXd system(7, nearest.corral.cols());
  system << nearest.corral, Eigen::RowVectorXd::Ones(nearest.corral.cols());
  Eigen::VectorXd right(7);
  right << nearest.point, 1.0;
  const Eigen::VectorXd share = system.colPivHouseholderQr().solve(right);
  for (Eigen::Index c = 0; c < nearest.corral.cols(); ++c) {
    for (const Eigen::Index j : facet) {
      if (wrenches.col(j) != nearest.corral.col(c)) continue;
      result.slope.col(j) = share[c] * ball.direction;
      break;
    }
  }
  result.value = ball.radius;
  result.known = true;
  return result;
}

}  // namespace

QualitySlope quality_slope(const Matrix6Xd& wrenches, PrecisionGoal goal) {
  return goal == PrecisionGoal::min_weight ? min_weight_slope(wrenches) : epsilon_slope(wrenches);
}

}  // namespace opponens::grasp
