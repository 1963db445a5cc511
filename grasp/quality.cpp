// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/quality.hpp"

#include "grasp/min_weight.hpp"
#include "grasp/origin_ball.hpp"
#include "grasp/wrench_hull.hpp"
#include "grasp/wrench_space.hpp"

namespace opponens::grasp {
namespace {

constexpr double kRankTolerance = 1e-9;       // relative to the largest singular value
constexpr std::size_t kMaxHullPoints = 5000;  // for the volume of a Minkowski sum

}  // namespace

GraspQuality evaluate(const std::vector<Contact>& contacts, const QualityConvention& convention,
                      const QualityRequest& request) {
  GraspQuality quality;
  quality.convention = convention;
  const Matrix6Xd wrenches = contact_wrenches(contacts, convention);
  if (wrenches.cols() == 0) return quality;
  const MinWeight weight = min_weight(wrenches);
  if (weight.state == MinWeight::State::optimal) quality.min_weight = weight.value;
  if (wrench_rank(wrenches, kRankTolerance) < 6) return quality;
  const WrenchSpace space(wrenches, static_cast<int>(wrenches.cols() / static_cast<Eigen::Index>(contacts.size())),
                          convention.norm);
  OriginBall ball = largest_origin_ball(space);
  if (!ball.converged) {
    // Rounding left the growing polytope inconsistent: the whole hull answers instead, where it is small enough.
    if (const auto hull = wrench_hull(space.points(kMaxHullPoints))) {
      ball.inside = hull->least_offset > kTouching * space.scale();
      ball.radius = ball.inside ? hull->least_offset : 0.0;
      ball.converged = true;
    }
  }
  quality.state = ball.inside ? ClosureState::force_closure : ClosureState::not_force_closure;
  if (ball.converged) quality.epsilon = ball.radius;  // else nobody knows it
  quality.direction = ball.direction;
  if (request.volume) {
    if (const auto hull = wrench_hull(space.points(kMaxHullPoints))) quality.volume = hull->volume;
  }
  return quality;
}

}  // namespace opponens::grasp
