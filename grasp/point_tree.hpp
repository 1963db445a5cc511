// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace opponens::grasp {

/// Points of a surface in balls within balls, at most 4 points in a leaf, so that the least value of a distance field
/// over many thousand points takes some dozen values of the field: a ball whose centre is farther than its radius
/// cannot hold a nearer point. Immutable.
class PointTree {
 public:
  PointTree() = default;
  explicit PointTree(std::vector<Eigen::Vector3d> points);

  bool empty() const { return points_.empty(); }
  const std::vector<Eigen::Vector3d>& points() const { return points_; }  ///< in the tree's order
  const Eigen::Vector3d& center() const { return balls_.front().center; }
  double radius() const { return balls_.front().radius; }  ///< m, about center(): of a ball that holds all points

  struct Descent {
    double bound;  ///< the last one
    double rest;   ///< least value that a point which was not visited can have; infinity when all were
  };
  /// Visits, nearest ball first, the points p whose distance may be below `bound`: visit(p, X p) looks at one and
  /// returns the bound from then on. least: Vector3d -> m, a lower bound of the distance.
  template <typename Least, typename Visit>
  Descent descend(const Least& least, const Eigen::Isometry3d& X, double bound, const Visit& visit) const;

 private:
  static constexpr int kLeaf = 4;
  static constexpr std::size_t kStackSize = 64;  // a tree of 2^60 points is not deeper
  struct Ball {
    Eigen::Vector3d center;
    double radius;
    int begin, end;  ///< of the points
    int second;      ///< index of the second child, the first follows its parent; 0: a leaf
  };
  void enclose(std::size_t begin, std::size_t end);

  std::vector<Eigen::Vector3d> points_;
  std::vector<Ball> balls_;
};

template <typename Least, typename Visit>
PointTree::Descent PointTree::descend(const Least& least, const Eigen::Isometry3d& X, double bound,
                                      const Visit& visit) const {
  double rest = std::numeric_limits<double>::infinity();
  if (balls_.empty()) return {bound, rest};
  struct Entry {
    double least;  ///< value a point of the ball can have
    int ball;
  };
  std::array<Entry, kStackSize> stack;  // NOLINT: filled before it is read
  std::size_t size = 0;
  const Eigen::Matrix3d R = X.linear();  // a product of these is inlined, one of Isometry3d is not
  const Eigen::Vector3d t = X.translation();
  const auto moved = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return R * p + t; };
  const auto entry = [&](int index) {
    const Ball& ball = balls_[static_cast<std::size_t>(index)];
    return Entry{least(moved(ball.center)) - ball.radius, index};
  };
  stack[size++] = entry(0);
  while (size > 0) {
    const Entry top = stack[--size];
    if (top.least >= bound) {
      rest = std::min(rest, top.least);
      continue;
    }
    const Ball& ball = balls_[static_cast<std::size_t>(top.ball)];
    if (ball.second == 0) {
      for (int i = ball.begin; i < ball.end; ++i) {
        const Eigen::Vector3d& p = points_[static_cast<std::size_t>(i)];
        bound = visit(p, moved(p));
      }
      continue;
    }
    Entry near = entry(top.ball + 1);
    Entry far = entry(ball.second);
    if (far.least < near.least) std::swap(near, far);
    for (const Entry& child : {far, near}) {
      if (child.least < bound) {
        stack[size++] = child;
      } else {
        rest = std::min(rest, child.least);
      }
    }
  }
  return {bound, rest};
}

}  // namespace opponens::grasp
