// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/sample_forest.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "core/require.hpp"

namespace opponens::motion {

SampleForest::SampleForest(const Eigen::VectorXd& weights)
    : dimension_(static_cast<int>(weights.size())),
      stride_((dimension_ + kLanes - 1) / kLanes * kLanes),
      weights_(index(stride_), 0.0),
      filter_(weights) {
  require(dimension_ > 0, "SampleForest: no joints");
  require((weights.array() > 0.0).all() && weights.allFinite(), "SampleForest: weights must be positive and finite");
  std::copy(weights.begin(), weights.end(), weights_.begin());
}

int SampleForest::append(const Eigen::VectorXd& q, int parent, int root) {
  require(q.size() == dimension_ && q.allFinite(), [&] {
    return "SampleForest: configuration must have " + std::to_string(dimension_) + " finite entries, got " +
           std::to_string(q.size());
  });
  q_.resize(q_.size() + index(stride_), 0.0);
  std::copy(q.begin(), q.end(), q_.end() - stride_);
  filter_.add(q.data());
  parent_.push_back(parent);
  root_.push_back(root);
  return size() - 1;
}

int SampleForest::add_root(const Eigen::VectorXd& q) { return append(q, -1, root_count_++); }

int SampleForest::add(const Eigen::VectorXd& q, int parent) {
  require(parent >= 0 && parent < size(), "SampleForest::add: no such parent: " + std::to_string(parent));
  return append(q, parent, root(parent));
}

double SampleForest::squared_distance(int vertex, const double* target) const {
  const double* const w = weights_.data();
  const double* const row = q_.data() + index(vertex) * index(stride_);
  double sum[kLanes] = {0.0, 0.0, 0.0, 0.0};
  for (int j = 0; j < stride_; j += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const double difference = row[j + lane] - target[j + lane];
      sum[lane] += w[j + lane] * difference * difference;
    }
  }
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

SampleForest::Nearest SampleForest::nearest(const Eigen::VectorXd& q) const {
  require(size() > 0 && q.size() == dimension_, "SampleForest::nearest: empty forest or wrong dimension");
  std::vector<double> target(index(stride_), 0.0);
  std::copy(q.begin(), q.end(), target.begin());
  double best = std::numeric_limits<double>::infinity();
  int nearest = 0;
  for (const int block : filter_.candidates(q.data())) {
    const int end = std::min(size(), (block + 1) * NearestFilter::kBlock);
    for (int i = block * NearestFilter::kBlock; i < end; ++i) {
      const double squared = squared_distance(i, target.data());
      if (squared < best) {
        best = squared;
        nearest = i;
      }
    }
  }
  return {nearest, std::sqrt(best)};
}

std::vector<int> SampleForest::path_from_root(int vertex) const {
  std::vector<int> path;
  for (int i = vertex; i >= 0; i = parent(i)) path.push_back(i);
  std::reverse(path.begin(), path.end());
  return path;
}

int SampleForest::remove_subtree(int vertex) {
  require(vertex >= 0 && vertex < size() && parent(vertex) >= 0,
          "SampleForest::remove_subtree: not a vertex with a parent: " + std::to_string(vertex));
  std::vector<int> renumbered(index(size()), -1);
  int kept = 0;
  for (int i = 0; i < size(); ++i) {
    // A parent comes before its children, so its fate is known here.
    const bool removed = i == vertex || (parent(i) >= 0 && renumbered[index(parent(i))] < 0);
    if (removed) continue;
    renumbered[index(i)] = kept;
    parent_[index(kept)] = parent(i) < 0 ? -1 : renumbered[index(parent(i))];
    root_[index(kept)] = root(i);
    std::copy_n(q_.begin() + static_cast<std::ptrdiff_t>(i) * stride_, stride_,
                q_.begin() + static_cast<std::ptrdiff_t>(kept) * stride_);
    ++kept;
  }
  const int removed = size() - kept;
  parent_.resize(index(kept));
  root_.resize(index(kept));
  q_.resize(index(kept) * index(stride_));
  filter_.clear();
  for (int i = 0; i < kept; ++i) filter_.add(q_.data() + index(i) * index(stride_));
  return removed;
}

}  // namespace opponens::motion
