// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/quality.hpp"

#include <cmath>
#include <string>

#include "core/require.hpp"
#include "grasp/min_weight.hpp"
#include "grasp/origin_ball.hpp"
#include "grasp/wrench_hull.hpp"
#include "grasp/wrench_space.hpp"

namespace opponens::grasp {
namespace {

constexpr double kRankTolerance = 1e-9;       // relative to the largest singular value
constexpr std::size_t kMaxHullPoints = 5000;  // for the volume of a Minkowski sum

OriginBall origin_ball(const WrenchSpace& space, const QualityRequest& request) {
  BallSearch search;
  if (request.at_least) search.at_least = *request.at_least;
  if (space.curved()) search.relative_gap = request.quadratic_gap;
  OriginBall ball = largest_origin_ball(space, search);
  if (ball.converged || space.curved()) return ball;
  // Rounding left the growing polytope inconsistent: the whole hull answers instead, where it is small enough.
  if (const auto hull = wrench_hull(space.points(kMaxHullPoints))) {
    ball.inside = hull->least_offset > kTouching * space.scale();
    ball.radius = ball.inside ? hull->least_offset : 0.0;
    ball.upper = ball.radius;
    ball.converged = true;
  }
  return ball;
}

}  // namespace

GraspQuality evaluate(const std::vector<Contact>& contacts, const QualityConvention& convention,
                      const QualityRequest& request) {
  require(request.quadratic_gap > 0.0 && request.quadratic_gap < 1.0,
          "evaluate: quadratic_gap must lie in (0, 1), got " + std::to_string(request.quadratic_gap));
  GraspQuality quality;
  quality.convention = convention;
  const Matrix6Xd wrenches = contact_wrenches(contacts, convention);
  if (wrenches.cols() == 0) return quality;
  const MinWeight weight = min_weight(wrenches);
  if (weight.state == MinWeight::State::optimal) quality.min_weight = weight.value;
  if (wrench_rank(wrenches, kRankTolerance) < 6) return quality;
  const WrenchSpace space(contacts, convention);
  const OriginBall ball = origin_ball(space, request);
  quality.state = ball.below    ? ClosureState::below_incumbent
                  : ball.inside ? ClosureState::force_closure
                                : ClosureState::not_force_closure;
  quality.direction = ball.direction;
  if (ball.below) return quality;
  if (ball.converged || space.curved()) quality.epsilon = ball.radius;  // else nobody knows it
  if (space.curved() && ball.radius != 0.0) quality.epsilon_gap = (ball.upper - ball.radius) / std::abs(ball.radius);
  if (request.volume) {
    if (const auto hull = wrench_hull(space.points(kMaxHullPoints))) quality.volume = hull->volume;
  }
  return quality;
}

}  // namespace opponens::grasp
