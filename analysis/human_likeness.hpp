// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

/// What human-likeness is measured against; the name is shown beside every value.
struct LikenessReference {
  std::string name;            ///< e.g. "free finger motions (simulated)" or "grasp phase of family 2"
  Eigen::MatrixXd covariance;  ///< [n x n] rad^2 of the reference motions of the hand
};

/// Whether a recording is of free finger motions (label kind = "free") and not of a movement to a grasp.
bool is_free_motion(const Demonstration& recording);

/// What the reference needs of one free motion.
struct FreeMotion {
  std::string id;
  bool simulated = false;
  SampleStatistics statistics;  ///< rad
};
FreeMotion free_motion(const Demonstration& recording);

/// The reference that free motions give; nullopt when there are none. Does not depend on their order.
std::optional<LikenessReference> free_motion_reference(std::vector<FreeMotion> motions);

/// The reference that the free motions among the recordings give, pooled by their weights; nullopt when there are none.
/// Does not depend on the order. All recordings have the same joints.
std::optional<LikenessReference> free_motion_reference(const std::vector<const Demonstration*>& recordings);

/// Human-likeness of a hand path, in (0, 100]. The formula behind the paper's Table 2 is unpublished; this one is ours
/// (docs/deviations.md, 7).
/// With x a segment of the path in hand space, Sigma the reference covariance and s1 its largest standard deviation:
///   c(x) = sqrt(x' Sigma x) / (|x| s1),   HL = 100 sum |x| c(x) / sum |x|.
/// 100 when the hand moves along the reference's first principal axis only. nullopt when the hand does not move or the
/// reference has no variance. Splitting a segment does not change it. q_h: [N x n] rad, row = waypoint. O(N n^2).
std::optional<double> human_likeness(const Eigen::Ref<const Eigen::MatrixXd>& q_h, const LikenessReference& reference);

}  // namespace opponens::analysis
