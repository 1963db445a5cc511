// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/min_norm_point.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/QR>

namespace opponens::grasp {
namespace {

constexpr int kMaxIterations = 1000;
constexpr double kGap = 1e-13;          // of the scale: distance error at which to stop
constexpr double kLeastWeight = 1e-14;  // a convex weight below this is dropped

using Small = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 7>;
using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1>;

/// Weights (sum 1) of the point of the affine hull of the columns that is nearest to the origin.
Weights affine_minimizer(const Small& s) {
  Weights weights(s.cols());
  weights[0] = 1.0;
  if (s.cols() == 1) return weights;
  const Small edges = s.rightCols(s.cols() - 1).colwise() - s.col(0);
  const Weights beta = edges.colPivHouseholderQr().solve(-s.col(0));
  weights.tail(beta.size()) = beta;
  weights[0] = 1.0 - beta.sum();
  return weights;
}

void drop(Small& s, Weights& weights, Eigen::Index column) {
  const Eigen::Index last = s.cols() - 1;
  for (Eigen::Index j = column; j < last; ++j) {
    s.col(j) = s.col(j + 1);
    weights[j] = weights[j + 1];
  }
  s.conservativeResize(6, last);
  weights.conservativeResize(last);
}

/// Wolfe's minor cycle: moves to the affine minimizer, dropping points whose weight would turn negative.
void minor_cycle(Small& s, Weights& weights) {
  while (true) {
    const Weights target = affine_minimizer(s);
    if (target.minCoeff() > kLeastWeight) {
      weights = target;
      return;
    }
    double step = std::numeric_limits<double>::infinity();
    Eigen::Index blocking = 0;
    for (Eigen::Index j = 0; j < target.size(); ++j) {
      if (target[j] > kLeastWeight) continue;
      const double limit = weights[j] / std::max(weights[j] - target[j], 1e-300);
      if (limit < step) {
        step = limit;
        blocking = j;
      }
    }
    weights += std::min(step, 1.0) * (target - weights);
    drop(s, weights, blocking);
    weights = weights.cwiseMax(0.0);
    weights /= weights.sum();
    if (s.cols() == 1) return;
  }
}

}  // namespace

MinNormPoint min_norm_point(const WrenchSpace& space, double relative_gap) {
  Small s(6, 1);
  s.col(0) = space.wrenches().col(0);
  if (space.norm() == WrenchNorm::linf) s.col(0) = space.support(-s.col(0).eval());
  Weights weights = Weights::Ones(1);
  Vector6d x = s.col(0);
  MinNormPoint best{x, -std::numeric_limits<double>::infinity(), Vector6d::Zero(), s};
  for (int iteration = 0; iteration < kMaxIterations && s.cols() < 7; ++iteration) {
    const double length = x.norm();
    if (length <= kGap * space.scale()) break;
    const Vector6d p = space.support(-x);
    if (const double least = x.dot(p) / length; least > best.least) {
      best.least = least;
      best.direction = -x / length;
    }
    if (length - best.least <= std::max(kGap * space.scale(), relative_gap * length)) break;
    if (((s.colwise() - p).colwise().squaredNorm().array() == 0.0).any()) break;
    s.conservativeResize(6, s.cols() + 1);
    s.rightCols<1>() = p;
    weights.conservativeResize(s.cols());
    weights[s.cols() - 1] = 0.0;
    minor_cycle(s, weights);
    const Vector6d next = s * weights;
    if (!(next.norm() < length)) break;  // no progress in floating point: x is as near as can be told
    x = next;
  }
  best.point = x;
  best.corral = s;
  return best;
}

}  // namespace opponens::grasp
