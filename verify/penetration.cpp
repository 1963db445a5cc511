// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

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

/// A ball of A's tree, or a part of a triangle in its leaves.
struct Piece {
  double upper;             ///< m, no point of it is deeper
  Probe at;                 ///< its middle
  int ball;                 ///< -1: a part of a triangle
  Eigen::Matrix3d corners;  ///< of that part, in B's frame

  bool operator<(const Piece& other) const { return upper < other.upper; }
};

class Search {
 public:
  Search(const Solid& A, const Solid& B, const Eigen::Isometry3d& X_BA) : A_(A), B_(B), X_BA_(X_BA) {}

  /// The pieces that may hold the deepest point first.
  Depth run(double enough) {
    if (!B_.closed() || A_.tree().balls().empty()) return {0.0, 0.0};
    const Eigen::Vector3d start = X_BA_ * A_.tree().balls()[0].center;
    push_ball(0, {start, B_.distance(start), B_.inside(start)});
    while (!open_.empty()) {
      const Piece piece = open_.top();
      if (piece.upper <= std::max(attained_ + kTolerance, enough)) break;
      open_.pop();
      if (piece.ball < 0) {
        divide(piece);
      } else {
        unfold(piece);
      }
    }
    return {attained_, std::max(attained_, open_.empty() ? 0.0 : open_.top().upper)};
  }

 private:
  /// Of the middle of a piece. Outside and at least its radius away, its distance is given as that radius.
  Probe probe(const Eigen::Vector3d& p, double radius, const Probe& near) const {
    const double apart = (p - near.p).norm();
    // From a probe near by follow a limit for the search in the tree, and often the side.
    const double limit = near.distance + apart + 1e-9;
    const bool inside = apart < near.distance ? near.inside : B_.inside(p);
    return {p, B_.distance(p, inside ? limit : std::min(limit, radius)), inside};
  }

  /// Pieces that lie outside as a whole are of no interest.
  void push(const Probe& at, double radius, int ball, const Eigen::Matrix3d& corners) {
    if (at.depth() + radius > 0.0) open_.push({at.depth() + radius, at, ball, corners});
  }

  void push_ball(int index, const Probe& near) {
    const BallTree::Ball& ball = A_.tree().balls()[static_cast<std::size_t>(index)];
    push(probe(X_BA_ * ball.center, ball.radius, near), ball.radius, index, Eigen::Matrix3d::Zero());
  }

  void push_triangle(const Eigen::Matrix3d& corners, const Probe& near) {
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const double radius = (corners.colwise() - middle).colwise().norm().maxCoeff();
    const Probe at = probe(middle, radius, near);
    attained_ = std::max(attained_, at.depth());
    push(at, radius, -1, corners);
  }

  void unfold(const Piece& piece) {
    const BallTree::Ball& ball = A_.tree().balls()[static_cast<std::size_t>(piece.ball)];
    if (!ball.leaf) {
      push_ball(piece.ball + 1, piece.at);
      push_ball(A_.tree().balls()[static_cast<std::size_t>(piece.ball) + 1].next, piece.at);
      return;
    }
    for (int i = ball.begin; i < ball.end; ++i) {
      const Eigen::Matrix3d corners = A_.tree().corners(A_.tree().order()[static_cast<std::size_t>(i)]);
      push_triangle((X_BA_.linear() * corners).colwise() + X_BA_.translation(), piece.at);
    }
  }

  /// Into quarters, so that a triangle ends at the latest when its radius is the tolerance.
  void divide(const Piece& piece) {
    Eigen::Matrix3d halves;
    for (int i = 0; i < 3; ++i) halves.col(i) = 0.5 * (piece.corners.col((i + 1) % 3) + piece.corners.col((i + 2) % 3));
    push_triangle(halves, piece.at);
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix3d corner = halves;
      corner.col(i) = piece.corners.col(i);
      push_triangle(corner, piece.at);
    }
  }

  const Solid& A_;
  const Solid& B_;
  const Eigen::Isometry3d& X_BA_;
  std::priority_queue<Piece> open_;
  double attained_ = 0.0;
};

}  // namespace

Depth penetration(const Solid& A, const Solid& B, const Eigen::Isometry3d& X_BA, double enough) {
  return Search(A, B, X_BA).run(enough);
}

}  // namespace opponens::verify
