// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/collision.hpp"
#include "robot/narrow_phase.hpp"

namespace opponens::robot {

/// Bounds of the distances of the pairs that a CollisionChecker checks, for proofs that they stay apart: balls, boxes,
/// convex hulls, convex pieces of meshes, and triangles only where all of these leave it open. Surfaces alone are
/// measured; the checker tells whether one solid is inside the other. Immutable, thread-safe; one Places per thread.
class PairGaps {
 public:
  /// The checker is referred to and must outlive this.
  explicit PairGaps(const CollisionChecker& checker);

  /// Two geometries, the first of the robot.
  struct Pair {
    int a;
    int b;
    int link_a;
    int link_b;        ///< -1: of the scene
    double radii = 0;  ///< m, sum of the bounding balls'
  };
  const std::vector<Pair>& pairs() const { return pairs_; }
  BodyPair names(const Pair& pair) const;

  /// Where everything is, and what was found of each pair before. To be used again and again.
  class Places {
    friend class PairGaps;
    const std::vector<Eigen::Isometry3d>* X_RL_ = nullptr;
    std::vector<Eigen::Vector3d> center_;  ///< [parts] m, of balls and boxes, in the root frame R
    std::vector<Eigen::Isometry3d> X_RG_;  ///< [parts]
    std::vector<std::uint64_t> known_;     ///< [parts] the number of the placement when X_RG was made
    std::uint64_t number_ = 0;
    std::vector<Eigen::Vector3d> away_;        ///< [pairs] direction that kept its hulls apart
    std::vector<std::pair<int, int>> pieces_;  ///< [pairs] pieces that were too near
  };
  /// Forgets what was found of pairs: answers then depend on nothing asked before.
  void reset(Places& places) const;
  /// X_RL: link poses, referred to until the next call.
  void place(const std::vector<Eigen::Isometry3d>& X_RL, Places& places) const;

  /// Lower bound from the balls alone, m; may be negative.
  double ball_gap(const Pair& pair, const Places& places) const {
    const Eigen::Vector3d between =
        places.center_[static_cast<std::size_t>(pair.a)] - places.center_[static_cast<std::size_t>(pair.b)];
    return between.norm() - pair.radii;
  }

  /// Bounds of pair number `index`, m, as far as it takes to tell that the distance is at least `enough` (so is lower
  /// then) or below `needed` (so is upper then); needed <= enough. The further these are apart, the less is done about
  /// it: parts of a motion that move far are cheaper halved. Within 1 mm it is known within 1e-6 m.
  GapBounds gap(std::size_t index, Places& places, double needed, double enough) const;

 private:
  const Eigen::Isometry3d& pose(int part, Places& places) const;

  const CollisionWorld& world_;
  std::vector<Pair> pairs_;
  std::vector<Eigen::Vector3d> center_;  ///< [parts] m, in the link; of the scene in R
  std::vector<Eigen::Isometry3d> X_BG_;  ///< [parts] in the link; of the scene in R
};

}  // namespace opponens::robot
