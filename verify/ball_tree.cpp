// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/ball_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

namespace opponens::verify {

double triangle_distance(const Eigen::Matrix3d& corners, const Eigen::Vector3d& p) {
  const Eigen::Vector3d ab = corners.col(1) - corners.col(0);
  const Eigen::Vector3d ac = corners.col(2) - corners.col(0);
  const Eigen::Vector3d ap = p - corners.col(0);
  const Eigen::Vector3d n = ab.cross(ac);
  const double area = n.squaredNorm();
  // Over the face when both barycentric coordinates of the foot, and what they leave, are not negative.
  const double v = ap.cross(ac).dot(n);
  const double w = ab.cross(ap).dot(n);
  // A needle's normal is rounding; its edges are as near as makes no difference.
  const bool face = area > 1e-14 * ab.squaredNorm() * ac.squaredNorm();
  if (face && v >= 0.0 && w >= 0.0 && v + w <= area) return std::abs(n.dot(ap)) / std::sqrt(area);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = corners.col(i);
    const Eigen::Vector3d edge = corners.col((i + 1) % 3) - a;
    const double length = edge.squaredNorm();
    const double along = length > 0.0 ? std::clamp(edge.dot(p - a) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - along * edge).squaredNorm());
  }
  return std::sqrt(least);
}

BallTree::BallTree(const robot::TriangleMesh& mesh)
    : mesh_(&mesh), order_(static_cast<std::size_t>(mesh.triangles.cols())) {
  std::iota(order_.begin(), order_.end(), 0);
  Eigen::Matrix3Xd middles(3, mesh.triangles.cols());
  for (Eigen::Index i = 0; i < middles.cols(); ++i) middles.col(i) = corners(static_cast<int>(i)).rowwise().mean();
  if (!order_.empty()) enclose(middles, 0, static_cast<int>(order_.size()));
}

Eigen::Matrix3d BallTree::corners(int triangle) const {
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) result.col(i) = mesh_->vertices.col(mesh_->triangles(i, triangle));
  return result;
}

void BallTree::enclose(const Eigen::Matrix3Xd& middles, int begin, int end) {
  constexpr int kLeaf = 4;
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d of_middles;
  for (int i = begin; i < end; ++i) {
    const int triangle = order_[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) box.extend(mesh_->vertices.col(mesh_->triangles(k, triangle)));
    of_middles.extend(Eigen::Vector3d(middles.col(triangle)));
  }
  Ball ball{box.center(), 0.0, begin, end, 0, end - begin <= kLeaf};
  for (int i = begin; i < end; ++i) {
    const Eigen::Matrix3d triangle = corners(order_[static_cast<std::size_t>(i)]);
    ball.radius = std::max(ball.radius, (triangle.colwise() - ball.center).colwise().norm().maxCoeff());
  }
  const std::size_t index = balls_.size();
  balls_.push_back(ball);
  if (!ball.leaf) {
    Eigen::Index axis = 0;
    of_middles.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    // Equal middles are told apart by their number, so the tree is the same everywhere.
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return std::pair(middles(axis, a), a) < std::pair(middles(axis, b), b); });
    enclose(middles, begin, middle);
    enclose(middles, middle, end);
  }
  balls_[index].next = static_cast<int>(balls_.size());
}

double BallTree::distance(const Eigen::Vector3d& p, double bound) const {
  double least = bound;
  // Nearer children first would prune more; a stack of two is enough for that in a binary tree of balls.
  std::vector<std::pair<double, int>> open;
  const auto push = [&](int ball) {
    const Ball& b = balls_[static_cast<std::size_t>(ball)];
    const double lower = (p - b.center).norm() - b.radius;
    if (lower < least) open.emplace_back(lower, ball);
  };
  if (!balls_.empty()) push(0);
  while (!open.empty()) {
    const auto [lower, index] = open.back();
    open.pop_back();
    if (lower >= least) continue;
    const Ball& ball = balls_[static_cast<std::size_t>(index)];
    if (ball.leaf) {
      for (int i = ball.begin; i < ball.end; ++i) {
        least = std::min(least, triangle_distance(corners(order_[static_cast<std::size_t>(i)]), p));
      }
      continue;
    }
    const int first = index + 1;
    push(first);
    const std::size_t before = open.size();
    push(balls_[static_cast<std::size_t>(first)].next);
    // The nearer one last: it is taken next.
    if (open.size() > before && before > 0 && open[before - 1].second == first &&
        open[before - 1].first < open.back().first) {
      std::swap(open[before - 1], open.back());
    }
  }
  return least;
}

}  // namespace opponens::verify
