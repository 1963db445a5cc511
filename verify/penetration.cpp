// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/penetration.hpp"

#include <algorithm>
#include <cmath>

namespace opponens::verify {
namespace {

constexpr double kTolerance = 5e-5;  // m

/// A point in B's frame whose side and distance are known: points nearer to it than that lie on the same side.
struct Probe {
  Eigen::Vector3d p;
  double distance;  ///< m, to B's surface
  bool inside;

  double depth() const { return inside ? distance : -distance; }
};

class Search {
 public:
  Search(const Solid& A, const Solid& B, const Eigen::Isometry3d& X_BA, double enough)
      : A_(A), B_(B), X_BA_(X_BA), enough_(enough) {}

  Depth run() {
    const Probe nowhere{Eigen::Vector3d::Zero(), 0.0, false};
    if (B_.closed() && !A_.tree().balls().empty()) visit(0, nowhere);
    return {attained_, std::max(bound_, attained_)};
  }

 private:
  Probe probe(const Eigen::Vector3d& p, const Probe& near) const {
    const double distance = B_.distance(p);
    const bool known = (p - near.p).norm() < near.distance;
    return {p, distance, known ? near.inside : B_.inside(p)};
  }

  /// Whether nothing within `radius` of the probe is of interest. What is left out counts for the bound.
  bool done(const Probe& at, double radius) {
    const double deepest = at.depth() + radius;
    if (deepest > 0.0 && deepest > std::max(attained_ + kTolerance, enough_)) return false;
    bound_ = std::max(bound_, deepest);
    return true;
  }

  void visit(int index, const Probe& above) {
    const BallTree::Ball& ball = A_.tree().balls()[static_cast<std::size_t>(index)];
    const Probe at = probe(X_BA_ * ball.center, above);
    if (done(at, ball.radius)) return;
    if (ball.leaf) {
      for (int i = ball.begin; i < ball.end; ++i) {
        const Eigen::Matrix3d corners = A_.tree().corners(A_.tree().order()[static_cast<std::size_t>(i)]);
        divide((X_BA_.linear() * corners).colwise() + X_BA_.translation(), at);
      }
      return;
    }
    visit(index + 1, at);
    visit(A_.tree().balls()[static_cast<std::size_t>(index) + 1].next, at);
  }

  /// corners: of a part of a triangle of A, in B's frame.
  void divide(const Eigen::Matrix3d& corners, const Probe& above) {
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const double radius = (corners.colwise() - middle).colwise().norm().maxCoeff();
    const Probe at = probe(middle, above);
    attained_ = std::max(attained_, at.depth());
    if (done(at, radius)) return;
    // A radius of the tolerance always ends above, so triangles are divided finitely often.
    Eigen::Matrix3d halves;
    for (int i = 0; i < 3; ++i) halves.col(i) = 0.5 * (corners.col((i + 1) % 3) + corners.col((i + 2) % 3));
    divide(halves, at);
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix3d corner = halves;
      corner.col(i) = corners.col(i);
      divide(corner, at);
    }
  }

  const Solid& A_;
  const Solid& B_;
  const Eigen::Isometry3d& X_BA_;
  double enough_;
  double attained_ = 0.0;
  double bound_ = 0.0;
};

}  // namespace

Depth penetration(const Solid& A, const Solid& B, const Eigen::Isometry3d& X_BA, double enough) {
  return Search(A, B, X_BA, enough).run();
}

}  // namespace opponens::verify
