// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/origin_ball.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>

#include "grasp/min_norm_point.hpp"

namespace opponens::grasp {
namespace {

constexpr double kOnPlane = 1e-11;    // of the scale: closer points are on a facet's plane
constexpr double kSuspicious = 1e-7;  // of the scale: gains below it are computed again from the facet's vertices
constexpr int kMaxVertices = 20000;

struct Facet {
  Vector6d normal;              // unit, outward
  double offset;                // normal'x = offset on the facet
  std::array<int, 6> vertex;    // ascending
  std::array<int, 6> neighbor;  // neighbor[i] shares all vertices but vertex[i]
  int stamp = 0;                // last growth step that looked at it; negative: and found it visible
  bool alive = true;
  bool exact = false;  // plane computed from the vertices, not from the neighbours
};

/// The plane through six points, oriented like guess; nullopt when they do not span one.
std::optional<Vector6d> plane_normal(const std::vector<Vector6d>& points, const std::array<int, 6>& vertex,
                                     const Vector6d& guess) {
  Eigen::Matrix<double, 6, 5> edges;
  for (int i = 0; i < 5; ++i) edges.col(i) = points[vertex[i + 1]] - points[vertex[0]];
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 6, 5>> qr(edges);
  if (std::abs(qr.matrixR()(4, 4)) <= 1e-12 * std::abs(qr.matrixR()(0, 0))) return std::nullopt;
  Vector6d normal = qr.householderQ() * Vector6d::Unit(5);
  if (normal.dot(guess) < 0.0) normal = -normal;
  return normal;
}

/// Open-addressing table from a ridge of the new cone (its four old vertices) to the facet and side waiting there.
class RidgeTable {
 public:
  void clear(std::size_t entries) {
    std::size_t size = 64;
    while (size < 4 * entries) size *= 2;
    slots_.assign(size, Slot{});
  }
  /// The partner that came before with this key, or nothing, and then (facet, side) waits for its partner.
  std::optional<std::pair<int, int>> match(std::uint64_t key, int facet, int side) {
    std::size_t i = (key * 0x9e3779b97f4a7c15ULL) >> 32;
    for (;; ++i) {
      Slot& slot = slots_[i & (slots_.size() - 1)];
      if (slot.facet < 0) {
        slot = {key, facet, side};
        return std::nullopt;
      }
      if (slot.key == key) return std::pair(slot.facet, slot.side);
    }
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    int facet = -1;
    int side = 0;
  };
  std::vector<Slot> slots_;
};

class Polytope {
 public:
  explicit Polytope(double scale) : tolerance_(kOnPlane * scale) {}

  void start(const Matrix6Xd& simplex);
  /// Nearest facet to the origin. It stays in the queue.
  int nearest();
  /// Grows by p, which lies beyond the given facet by more than the tolerance. False when the surface is inconsistent.
  bool add(int seen, const Vector6d& p);
  /// Computes the facet's plane from its vertices and queues it again when that changed its offset.
  void refine(int index);

  const Facet& facet(int index) const { return facets_[index]; }
  std::int64_t facets() const { return static_cast<std::int64_t>(facets_.size()); }
  std::int64_t vertices() const { return static_cast<std::int64_t>(points_.size()); }

 private:
  using Entry = std::pair<double, int>;
  void find_visible(int seen, const Vector6d& p);
  bool make_cone(int from, int side, int apex, const Vector6d& p);

  double tolerance_;
  std::vector<Vector6d> points_;
  std::vector<Facet> facets_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<int> visible_;
  RidgeTable ridges_;
  int step_ = 0;
};

void Polytope::start(const Matrix6Xd& simplex) {
  Vector6d center = Vector6d::Zero();
  for (Eigen::Index i = 0; i < 7; ++i) {
    points_.push_back(simplex.col(i));
    center += simplex.col(i) / 7.0;
  }
  for (int left_out = 0; left_out < 7; ++left_out) {
    Facet facet;
    for (int i = 0, v = 0; v < 7; ++v) {
      if (v == left_out) continue;
      facet.vertex[i] = v;
      facet.neighbor[i++] = v;  // facet v is the one without vertex v
    }
    facet.normal = plane_normal(points_, facet.vertex, points_[facet.vertex[0]] - center).value_or(Vector6d::Unit(0));
    facet.offset = facet.normal.dot(points_[facet.vertex[0]]);
    facet.exact = true;
    queue_.emplace(facet.offset, left_out);
    facets_.push_back(facet);
  }
}

int Polytope::nearest() {
  while (!facets_[queue_.top().second].alive || facets_[queue_.top().second].offset != queue_.top().first) queue_.pop();
  return queue_.top().second;
}

void Polytope::refine(int index) {
  Facet& facet = facets_[index];
  facet.exact = true;
  const auto normal = plane_normal(points_, facet.vertex, facet.normal);
  if (!normal) return;
  facet.normal = *normal;
  const double offset = normal->dot(points_[facet.vertex[0]]);
  if (offset == facet.offset) return;
  facet.offset = offset;
  queue_.emplace(offset, index);
}

void Polytope::find_visible(int seen, const Vector6d& p) {
  ++step_;
  visible_.assign(1, seen);
  facets_[seen].stamp = -step_;
  for (std::size_t next = 0; next < visible_.size(); ++next) {
    for (const int neighbor : facets_[visible_[next]].neighbor) {
      Facet& facet = facets_[neighbor];
      if (facet.stamp == step_ || facet.stamp == -step_) continue;
      const bool sees = facet.normal.dot(p) - facet.offset > tolerance_;
      facet.stamp = sees ? -step_ : step_;
      if (sees) visible_.push_back(neighbor);
    }
  }
}

bool Polytope::make_cone(int from, int side, int apex, const Vector6d& p) {
  const int index = static_cast<int>(facets_.size());
  const int outer = facets_[from].neighbor[side];
  Facet facet;
  for (int i = 0, k = 0; i < 6; ++i) {
    if (i != side) facet.vertex[k++] = facets_[from].vertex[i];
  }
  facet.vertex[5] = apex;
  // The planes through the shared ridge form a pencil: n = d_1 n_2 - d_2 n_1 passes through p, and points outward.
  const double d_1 = facets_[from].normal.dot(p) - facets_[from].offset;
  const double d_2 = facets_[outer].normal.dot(p) - facets_[outer].offset;
  facet.normal = d_1 * facets_[outer].normal - d_2 * facets_[from].normal;
  facet.normal.normalize();
  facet.offset = facet.normal.dot(p);
  facet.neighbor[5] = outer;
  for (int& back : facets_[outer].neighbor) {
    if (back == from) back = index;
  }
  for (int i = 0; i < 5; ++i) {
    std::uint64_t key = 0;
    for (int k = 0; k < 5; ++k) {
      if (k != i) key = (key << 16) | static_cast<std::uint64_t>(facet.vertex[k]);
    }
    facet.neighbor[i] = -1;
    if (const auto partner = ridges_.match(key, index, i)) {
      int& waiting =
          partner->first == index ? facet.neighbor[partner->second] : facets_[partner->first].neighbor[partner->second];
      if (waiting >= 0) return false;  // three facets at one ridge: not a manifold
      waiting = index;
      facet.neighbor[i] = partner->first;
    }
  }
  queue_.emplace(facet.offset, index);
  facets_.push_back(facet);
  return true;
}

bool Polytope::add(int seen, const Vector6d& p) {
  find_visible(seen, p);
  const int apex = static_cast<int>(points_.size());
  const std::size_t first_new = facets_.size();
  points_.push_back(p);
  ridges_.clear(visible_.size() * 6);
  for (const int index : visible_) {
    facets_[index].alive = false;
    for (int side = 0; side < 6; ++side) {
      if (facets_[facets_[index].neighbor[side]].stamp == -step_) continue;
      if (!make_cone(index, side, apex, p)) return false;
    }
  }
  for (std::size_t i = first_new; i < facets_.size(); ++i) {
    for (const int neighbor : facets_[i].neighbor) {
      if (neighbor < 0) return false;  // the horizon does not close
    }
  }
  return true;
}

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

}  // namespace

OriginBall largest_origin_ball(const WrenchSpace& space) {
  const MinNormPoint nearest = min_norm_point(space);
  const double distance = nearest.point.norm();
  const double scale = space.scale();
  if (distance > kTouching * scale) return {-distance, -nearest.point / distance, false};
  const Matrix6Xd simplex = complete_simplex(space, nearest.corral);
  if (simplex.cols() < 7) return {0.0, Vector6d::Zero(), false};
  Polytope polytope(scale);
  polytope.start(simplex);
  OriginBall ball{};
  while (true) {
    const int index = polytope.nearest();
    const Vector6d normal = polytope.facet(index).normal;
    const double offset = polytope.facet(index).offset;
    const Vector6d p = space.support(normal);
    const double gain = normal.dot(p) - offset;
    if (gain < kSuspicious * scale && !polytope.facet(index).exact) {
      polytope.refine(index);
      continue;
    }
    ball = {std::min(offset, normal.dot(p)), normal, offset > kTouching * scale, polytope.facets(),
            polytope.vertices()};
    if (gain <= kOnPlane * scale) break;
    if (polytope.vertices() >= kMaxVertices || !polytope.add(index, p)) {
      ball.converged = false;
      break;
    }
  }
  if (!ball.inside) ball.radius = std::min(ball.radius, 0.0);
  return ball;
}

}  // namespace opponens::grasp
