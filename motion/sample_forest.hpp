// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "motion/nearest_filter.hpp"

namespace opponens::motion {

/// A graph (E, V) of Algorithm 2: one or more trees of configurations in one structure. Vertices lie one after the
/// other in one buffer, each padded to a whole number of lanes.
/// A vertex's index is larger than its parent's.
class SampleForest {
 public:
  /// weights: [d] of the joint metric, each positive.
  explicit SampleForest(const Eigen::VectorXd& weights);

  /// Both return the new vertex's index. q: [d] rad. Roots are numbered 0, 1, ... in the order they are added.
  int add_root(const Eigen::VectorXd& q);
  int add(const Eigen::VectorXd& q, int parent);

  int size() const { return static_cast<int>(parent_.size()); }
  Eigen::Map<const Eigen::VectorXd> weights() const { return {weights_.data(), dimension_}; }
  int root_count() const { return root_count_; }
  int parent(int vertex) const { return parent_[index(vertex)]; }  ///< -1 for a root
  int root(int vertex) const { return root_[index(vertex)]; }      ///< number of the root of its tree
  /// [d] rad. Valid until the next vertex is added or removed.
  Eigen::Map<const Eigen::VectorXd> vertex(int vertex) const {
    return {q_.data() + index(vertex) * index(stride_), dimension_};
  }

  struct Nearest {
    int vertex;
    double distance;  ///< rad, weighted metric
  };
  /// Nearest vertex to q in the weighted metric (the lowest index among equals). Two linear scans: one in single
  /// precision leaves out what is further away for certain, one in double precision decides among the rest; the sum has
  /// a fixed order of four lanes, so the processor's instructions do not show. At the sizes of these searches (<= 1e5
  /// vertices in 22 dimensions) faster than OMPL's GNAT (docs/algorithms/planner.md). Requires a non-empty forest.
  Nearest nearest(const Eigen::VectorXd& q) const;

  /// Vertices from the root of its tree to this vertex.
  std::vector<int> path_from_root(int vertex) const;

  /// Removes a vertex that is not a root, with everything grown from it; the others keep their order but are
  /// renumbered. Returns the number removed. Cost: one pass.
  int remove_subtree(int vertex);

 private:
  static constexpr int kLanes = 4;
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  int append(const Eigen::VectorXd& q, int parent, int root);
  /// target: [stride], zero in the padding.
  double squared_distance(int vertex, const double* target) const;

  int dimension_;
  int stride_;                   ///< dimension rounded up to whole lanes
  std::vector<double> weights_;  ///< [stride], zero in the padding
  std::vector<double> q_;        ///< [size x stride], zero in the padding
  NearestFilter filter_;
  std::vector<int> parent_;
  std::vector<int> root_;
  int root_count_ = 0;
};

}  // namespace opponens::motion
