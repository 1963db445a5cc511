// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace opponens::motion {

/// Some of the configurations at which steps were blocked, spread evenly over the search: every one at first, then
/// every second, every fourth, ... so that no more than kMost are kept.
class BlockedRecord {
 public:
  static constexpr std::size_t kMost = 64;

  /// The configuration at that fraction of the motion, which is invalid. [d] rad.
  void add(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, double fraction);

  std::int64_t seen() const { return seen_; }
  const std::vector<Eigen::VectorXd>& kept() const { return kept_; }

 private:
  std::int64_t seen_ = 0;
  std::int64_t stride_ = 1;
  std::vector<Eigen::VectorXd> kept_;
};

/// How near two graphs came without meeting, as far as CONNECT saw it: it asks of every new vertex.
struct Approach {
  double gap = std::numeric_limits<double>::infinity();  ///< rad, joint metric
  int root_a = -1;                                       ///< of the two vertices' trees, in the order of the graphs
  int root_b = -1;                                       ///< that CONNECT was given
};

struct SearchCounts {
  std::int64_t extends = 0;           ///< calls of SYNEXTEND
  std::int64_t extends_grown = 0;     ///< those that added a vertex
  std::int64_t collision_checks = 0;  ///< configurations evaluated
  BlockedRecord blocked{};
  Approach closest{};
};

}  // namespace opponens::motion
