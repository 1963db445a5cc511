// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "grasp/wrench_space.hpp"

namespace opponens::grasp {

/// Table from a ridge of a new cone (its four old vertices) to the facet and side waiting there for a partner. Entries
/// of earlier steps count as empty, so that nothing is ever cleared.
class RidgeTable {
 public:
  void begin(int step, std::size_t entries);
  /// The partner that came before with this key, or nothing, and then (facet, side) waits for its partner.
  std::optional<std::pair<int, int>> match(std::uint64_t key, int facet, int side);

 private:
  struct Slot {
    std::uint64_t key = 0;
    int step = 0;
    int facet_and_side = 0;  // 8 facet + side
  };
  std::vector<Slot> slots_;
  int step_ = 0;
};

/// A polytope in R^6 whose vertices belong to a convex set: a simplicial complex kept as in beneath-beyond, each facet
/// with its six neighbours. Points within `tolerance` of a facet's plane count as on it, so coplanar and repeated
/// points make no flat facets.
class InnerPolytope {
 public:
  struct Facet {
    Vector6d normal;              // unit, outward
    double offset;                // normal'x = offset on the facet
    std::array<int, 6> vertex;    // ascending
    std::array<int, 6> neighbor;  // neighbor[i] shares all vertices but vertex[i]
    int stamp = 0;                // last growth step that looked at it; negative: and found it visible
    bool exact = false;           // plane computed from the vertices, not from the neighbours
  };

  /// simplex: [6 x 7], affinely independent.
  InnerPolytope(const Matrix6Xd& simplex, double tolerance);

  /// The facet nearest to the origin among those nearer than the ceilings given; -1: there is none. It stays queued.
  int nearest();
  /// Grows by p, which lies beyond the facet `seen` by more than the tolerance. New facets further away than `ceiling`
  /// are not queued: they cannot decide. False when rounding left the surface inconsistent.
  bool add(int seen, const Vector6d& p, double ceiling);
  /// Computes the facet's plane from its vertices and queues it again when that changed its offset.
  void refine(int index);

  const Facet& facet(int index) const { return facets_[static_cast<std::size_t>(index)]; }
  std::int64_t facets_made() const { return made_; }
  std::int64_t vertices() const { return static_cast<std::int64_t>(points_.size()); }

 private:
  using Entry = std::pair<double, int>;
  void find_visible(int seen, const Vector6d& p);
  bool make_facet(int from, int side, int apex, const Vector6d& p, double ceiling);
  int new_index();

  double tolerance_;
  std::vector<Vector6d> points_;
  std::vector<Facet> facets_;
  std::vector<int> unused_;  // of facets_
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<int> visible_;
  std::vector<std::pair<int, int>> horizon_;  // visible facet, side behind which the surface stays
  std::vector<int> cone_;                     // the facets of this step
  RidgeTable ridges_;
  int step_ = 0;
  std::int64_t made_ = 0;
};

}  // namespace opponens::grasp
