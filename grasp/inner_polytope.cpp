// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/inner_polytope.hpp"

#include <cmath>

#include <Eigen/QR>

namespace opponens::grasp {
namespace {

/// The plane through six points, oriented like guess; nullopt when they do not span one.
std::optional<Vector6d> plane_normal(const std::vector<Vector6d>& points, const std::array<int, 6>& vertex,
                                     const Vector6d& guess) {
  Eigen::Matrix<double, 6, 5> edges;
  const Vector6d& base = points[static_cast<std::size_t>(vertex[0])];
  for (int i = 0; i < 5; ++i) edges.col(i) = points[static_cast<std::size_t>(vertex[i + 1])] - base;
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 6, 5>> qr(edges);
  if (std::abs(qr.matrixR()(4, 4)) <= 1e-12 * std::abs(qr.matrixR()(0, 0))) return std::nullopt;
  Vector6d normal = qr.householderQ() * Vector6d::Unit(5);
  if (normal.dot(guess) < 0.0) normal = -normal;
  return normal;
}

}  // namespace

void RidgeTable::begin(int step, std::size_t entries) {
  step_ = step;
  if (slots_.size() >= 2 * entries) return;
  std::size_t size = 256;
  while (size < 4 * entries) size *= 2;
  slots_.assign(size, Slot{});
}

std::optional<std::pair<int, int>> RidgeTable::match(std::uint64_t key, int facet, int side) {
  for (std::size_t i = (key * 0x9e3779b97f4a7c15ULL) >> 32;; ++i) {
    Slot& slot = slots_[i & (slots_.size() - 1)];
    if (slot.step != step_) {
      slot = {key, step_, 8 * facet + side};
      return std::nullopt;
    }
    if (slot.key == key) return std::pair(slot.facet_and_side / 8, slot.facet_and_side % 8);
  }
}

InnerPolytope::InnerPolytope(const Matrix6Xd& simplex, double tolerance) : tolerance_(tolerance) {
  points_.reserve(64);
  facets_.reserve(1024);
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
    const Vector6d& base = points_[static_cast<std::size_t>(facet.vertex[0])];
    facet.normal = plane_normal(points_, facet.vertex, base - center).value_or(Vector6d::Unit(0));
    facet.offset = facet.normal.dot(base);
    facet.exact = true;
    queue_.emplace(facet.offset, left_out);
    facets_.push_back(facet);
  }
  made_ = 7;
}

int InnerPolytope::nearest() {
  // A facet that is gone has no offset, or that of the one that took its place: an entry that fits is never stale.
  while (!queue_.empty() && facets_[static_cast<std::size_t>(queue_.top().second)].offset != queue_.top().first) {
    queue_.pop();
  }
  return queue_.empty() ? -1 : queue_.top().second;
}

void InnerPolytope::refine(int index) {
  Facet& facet = facets_[static_cast<std::size_t>(index)];
  facet.exact = true;
  const auto normal = plane_normal(points_, facet.vertex, facet.normal);
  if (!normal) return;
  facet.normal = *normal;
  const double offset = normal->dot(points_[static_cast<std::size_t>(facet.vertex[0])]);
  if (offset == facet.offset) return;
  facet.offset = offset;
  queue_.emplace(offset, index);
}

void InnerPolytope::find_visible(int seen, const Vector6d& p) {
  ++step_;
  visible_.assign(1, seen);
  horizon_.clear();
  facets_[static_cast<std::size_t>(seen)].stamp = -step_;
  for (std::size_t next = 0; next < visible_.size(); ++next) {
    const int index = visible_[next];
    for (int side = 0; side < 6; ++side) {
      const int neighbor = facets_[static_cast<std::size_t>(index)].neighbor[static_cast<std::size_t>(side)];
      Facet& facet = facets_[static_cast<std::size_t>(neighbor)];
      if (facet.stamp == -step_) continue;
      if (facet.stamp != step_ && facet.normal.dot(p) - facet.offset > tolerance_) {
        facet.stamp = -step_;
        visible_.push_back(neighbor);
      } else {
        facet.stamp = step_;
        horizon_.emplace_back(index, side);
      }
    }
  }
}

int InnerPolytope::new_index() {
  ++made_;
  if (unused_.empty()) {
    facets_.emplace_back();
    return static_cast<int>(facets_.size()) - 1;
  }
  const int index = unused_.back();
  unused_.pop_back();
  return index;
}

bool InnerPolytope::make_facet(int from, int side, int apex, const Vector6d& p, double ceiling) {
  const int index = new_index();
  Facet& facet = facets_[static_cast<std::size_t>(index)];
  const Facet& gone = facets_[static_cast<std::size_t>(from)];
  const int behind = gone.neighbor[static_cast<std::size_t>(side)];
  Facet& outer = facets_[static_cast<std::size_t>(behind)];
  for (int i = 0, k = 0; i < 6; ++i) {
    if (i != side) facet.vertex[k++] = gone.vertex[i];
  }
  facet.vertex[5] = apex;
  // The planes through the shared ridge form a pencil: n = d_1 n_2 - d_2 n_1 passes through p, and points outward.
  const double d_1 = gone.normal.dot(p) - gone.offset;
  const double d_2 = outer.normal.dot(p) - outer.offset;
  facet.normal = d_1 * outer.normal - d_2 * gone.normal;
  facet.normal *= 1.0 / facet.normal.norm();
  facet.offset = facet.normal.dot(p);
  facet.stamp = 0;
  facet.exact = false;
  facet.neighbor = {-1, -1, -1, -1, -1, behind};
  for (int& back : outer.neighbor) {
    if (back == from) back = index;
  }
  for (int i = 0; i < 5; ++i) {
    std::uint64_t key = 0;
    for (int k = 0; k < 5; ++k) {
      if (k != i) key = (key << 16) | static_cast<std::uint64_t>(facet.vertex[k]);
    }
    if (const auto partner = ridges_.match(key, index, i)) {
      int& waiting =
          facets_[static_cast<std::size_t>(partner->first)].neighbor[static_cast<std::size_t>(partner->second)];
      if (waiting >= 0) return false;  // three facets at one ridge: not a manifold
      waiting = index;
      facet.neighbor[i] = partner->first;
    }
  }
  cone_.push_back(index);
  if (!(facet.offset > ceiling)) queue_.emplace(facet.offset, index);
  return true;
}

bool InnerPolytope::add(int seen, const Vector6d& p, double ceiling) {
  find_visible(seen, p);
  const int apex = static_cast<int>(points_.size());
  points_.push_back(p);
  ridges_.begin(step_, 5 * horizon_.size() / 2);
  cone_.clear();
  // Places of facets that go now are filled in the next step: the cone still reads them.
  for (const auto& [index, side] : horizon_) {
    if (!make_facet(index, side, apex, p, ceiling)) return false;
  }
  for (const int index : visible_) {
    facets_[static_cast<std::size_t>(index)].offset = std::numeric_limits<double>::quiet_NaN();
    unused_.push_back(index);
  }
  for (const int index : cone_) {
    for (const int neighbor : facets_[static_cast<std::size_t>(index)].neighbor) {
      if (neighbor < 0) return false;  // the horizon does not close
    }
  }
  return true;
}

}  // namespace opponens::grasp
