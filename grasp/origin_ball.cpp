// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/origin_ball.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "core/require.hpp"
#include "grasp/facet_descent.hpp"
#include "grasp/inner_polytope.hpp"
#include "grasp/min_norm_point.hpp"

namespace opponens::grasp {
namespace {

constexpr double kOnPlane = 1e-11;    // of the scale: closer points are on a facet's plane
constexpr double kSuspicious = 1e-7;  // of the scale: gains below it are computed again from the facet's vertices
constexpr int kMaxVertices = 20000;

/// Completes the corral around the origin to seven affinely independent points of the set; fewer when it is flat.
Matrix6Xd complete_simplex(const WrenchSpace& space, const Matrix6Xd& corral) {
  Matrix6Xd simplex = corral;
  while (simplex.cols() < 7) {
    // Directions orthogonal to the affine hull so far; the support point furthest off it joins.
    const Eigen::Index edges = simplex.cols() - 1;
    Eigen::Matrix<double, 6, 6> basis = Eigen::Matrix<double, 6, 6>::Identity();
    if (edges > 0) {
      const Eigen::MatrixXd differences = simplex.rightCols(edges).colwise() - simplex.col(0);
      basis = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(differences).householderQ();
    }
    Vector6d best = Vector6d::Zero();
    double furthest = kOnPlane * space.scale();
    for (Eigen::Index i = edges; i < 6; ++i) {
      for (const double sign : {1.0, -1.0}) {
        const Vector6d u = sign * basis.col(i);
        const Vector6d p = space.support(u);
        const double gain = u.dot(p - simplex.col(0));
        if (gain > furthest) {
          furthest = gain;
          best = p;
        }
      }
    }
    if (furthest == kOnPlane * space.scale()) break;
    simplex.conservativeResize(6, simplex.cols() + 1);
    simplex.rightCols<1>() = best;
  }
  return simplex;
}

/// Grows the polytope until its nearest facet decides, or an upper bound is low enough to give up.
OriginBall grow(const WrenchSpace& space, const Matrix6Xd& simplex, const BallSearch& search, OriginBall ball) {
  const double scale = space.scale();
  InnerPolytope polytope(simplex, kOnPlane * scale);
  while (true) {
    const int index = polytope.nearest();
    if (index < 0) {  // every facet is further away than a plane that no point of the set passes
      ball.radius = ball.upper;
      break;
    }
    const Vector6d normal = polytope.facet(index).normal;
    const double offset = polytope.facet(index).offset;
    const Vector6d p = space.support(normal);
    const double gain = normal.dot(p) - offset;
    if (gain < kSuspicious * scale && !polytope.facet(index).exact) {
      polytope.refine(index);
      continue;
    }
    if (normal.dot(p) < ball.upper) {
      ball.upper = normal.dot(p);
      ball.direction = normal;
    }
    ball.radius = std::min(offset, ball.upper);
    ball.below = ball.upper < search.at_least;
    const double gap = std::max(kOnPlane * scale, search.relative_gap * ball.upper);
    if (ball.below || gain <= kOnPlane * scale || ball.upper - offset <= gap) break;
    const double ceiling = ball.upper + kSuspicious * scale;
    if (polytope.vertices() >= kMaxVertices || !polytope.add(index, p, ceiling)) {
      ball.converged = false;
      break;
    }
  }
  ball.facets = polytope.facets_made();
  ball.vertices = polytope.vertices();
  return ball;
}

}  // namespace

OriginBall largest_origin_ball(const WrenchSpace& space, const BallSearch& search) {
  require(!space.curved() || search.relative_gap > 0.0, "largest_origin_ball: a curved set needs a relative_gap > 0");
  const double touching = kTouching * space.scale();
  const MinNormPoint nearest = min_norm_point(space, search.relative_gap);
  const double distance = nearest.point.norm();
  // A set of points: the nearest point is exact. A curved set: outside only where a direction separates it.
  if (!space.curved() && distance > touching) return {-distance, -distance, -nearest.point / distance, false};
  if (space.curved() && nearest.least > touching) return {-distance, -nearest.least, nearest.direction, false};
  const Matrix6Xd simplex = complete_simplex(space, nearest.corral);
  if (simplex.cols() < 7) return {0.0, 0.0, Vector6d::Zero(), false};
  OriginBall ball{};
  ball.upper = std::numeric_limits<double>::infinity();
  if (!space.curved() && space.norm() == WrenchNorm::l1) {
    // What pushes least against the contacts' mean: near the weakest direction of most grasps.
    const SupportBound bound = descend_facets(space.wrenches(), -space.wrenches().rowwise().mean(), search.at_least);
    ball.upper = bound.value;
    ball.direction = bound.direction;
  }
  ball.below = ball.upper < search.at_least;
  if (!ball.below) ball = grow(space, simplex, search, ball);
  ball.inside = !ball.below && ball.radius > touching;
  if (!ball.inside && !ball.below) ball.radius = std::min(ball.radius, 0.0);
  return ball;
}

}  // namespace opponens::grasp
