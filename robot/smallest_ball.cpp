// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/smallest_ball.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kLooseness = 1e-3;  ///< share by which a ball may be larger than the smallest
constexpr int kMostPivots = 32;      ///< points that may be added to a ball's support, one after the other

/// Two lists of points.
using Points = std::array<std::span<const Vector3d>, 2>;

/// The point farthest from a center, and its squared distance.
std::pair<const Vector3d*, double> farthest(const Points& lists, const Vector3d& center) {
  std::pair<const Vector3d*, double> far{nullptr, -1.0};
  for (const auto& list : lists) {
    for (const Vector3d& p : list) {
      const double squared = (p - center).squaredNorm();
      if (squared > far.second) far = {&p, squared};
    }
  }
  return far;
}

/// Up to four points and the smallest ball with all of them on its surface.
struct BallSupport {
  std::array<Vector3d, 4> points;
  int count = 0;
  Vector3d center = Vector3d::Zero();
  double squared = std::numeric_limits<double>::infinity();  ///< radius, m^2

  void add(const Vector3d& p) { points[static_cast<std::size_t>(count++)] = p; }

  /// The center is points[0] + sum_i l_i v_i with v_i = points[i] - points[0], where 2 sum_j (v_i v_j) l_j = v_i v_i.
  /// NaN or something far away when the points have no such ball.
  void circumscribe() {
    using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
    Small v(3, count - 1);
    for (int i = 1; i < count; ++i) v.col(i - 1) = points[static_cast<std::size_t>(i)] - points[0];
    Vector3d offset = Vector3d::Zero();
    if (count == 2) offset = 0.5 * v.col(0);
    if (count > 2) {
      const Small gram = v.transpose() * v;
      const Column right = 0.5 * gram.diagonal();
      offset = v * Column(gram.ldlt().solve(right));
    }
    center = points[0] + offset;
    squared = offset.squaredNorm();
  }
};

/// The smallest ball around the points of another and one more, which lies outside that and so on the surface of this:
/// the smallest of the balls through it and up to three of the others that contains all. Unchanged when rounding leaves
/// none.
BallSupport pivot(const BallSupport& old, const Vector3d& p) {
  BallSupport best;
  for (unsigned chosen = 0; chosen < 1U << old.count; ++chosen) {
    if (std::popcount(chosen) > 3) continue;
    BallSupport ball;
    ball.add(p);
    for (int i = 0; i < old.count; ++i) {
      if ((chosen >> i & 1U) != 0) ball.add(old.points[static_cast<std::size_t>(i)]);
    }
    ball.circumscribe();
    if (!(ball.squared < best.squared)) continue;
    const bool contains = std::all_of(old.points.begin(), old.points.begin() + old.count, [&](const Vector3d& other) {
      return (other - ball.center).squaredNorm() <= ball.squared * (1.0 + 1e-9);
    });
    if (contains) best = ball;
  }
  return best.count > 0 ? best : old;
}

}  // namespace

EnclosingBall enclosing_ball(std::span<const Vector3d> points, std::span<const Vector3d> more) {
  require(!points.empty() || !more.empty(), "enclosing_ball: no points");
  const Points lists{points, more};
  Eigen::AlignedBox3d box;
  for (const auto& list : lists) {
    for (const Vector3d& p : list) box.extend(p);
  }
  EnclosingBall ball{box.center(), 0.0};
  double least = std::numeric_limits<double>::infinity();
  BallSupport support;
  support.center = ball.center;
  support.squared = 0.0;
  for (int i = 0; i < kMostPivots; ++i) {
    const auto [far, squared] = farthest(lists, support.center);
    if (squared < least) {
      least = squared;
      ball.center = support.center;
    }
    if (squared <= support.squared * (1.0 + 2.0 * kLooseness)) break;
    support = pivot(support, *far);
  }
  ball.radius = std::sqrt(least);
  return ball;
}

}  // namespace opponens::robot
