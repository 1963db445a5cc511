// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "motion/followed_boxes.hpp"
#include "motion/world.hpp"

namespace opponens::motion {

/// Distances of a configuration from what is around it, m: always as many, in the same order; negative inside.
/// derivative: [m x d] m/rad, filled when not null. Same argument, same answer.
using Clearances = std::function<Eigen::VectorXd(const Eigen::VectorXd& q, Eigen::MatrixXd* derivative)>;

struct SmoothSettings {
  int points = 40;                 ///< intervals that the path is divided into, about
  int iterations = 15;             ///< of the solver; the only limit
  double box_weight = 3.0;         ///< of a distance beyond the followed box's limit, against |q''| per rad
  double clearance = 0.01;         ///< m, wanted from obstacles
  double clearance_weight = 30.0;  ///< of a metre that lacks
  int halvings = 4;                ///< of the change of a part that is not valid
};
void validate(const SmoothSettings& settings);  ///< throws std::invalid_argument naming field, value, constraint

/// What a smoothing changes: lower is smoother.
struct Smoothness {
  double length = 0.0;   ///< rad, weighted metric
  double bending = 0.0;  ///< integral of |q''|^2 ds over the resampled path, 1/rad, weighted metric
};

struct Smoothed {
  JointPath path;     ///< the given one when nothing could be kept of the change
  Smoothness before;  ///< both of the resampled path
  Smoothness after;
  int moved = 0;   ///< points of the change that were kept
  int points = 0;  ///< inner ones
  std::int64_t collision_checks = 0;
};

/// Smooths a whole path at once: the path is divided evenly along each segment, and its inner points are moved to
/// minimise the bending (second differences by arc length, weighted metric) plus penalties for what lies beyond the
/// boxes' limits and nearer than `clearance`, within the joint limits as bounds; ends and the point where the boxes
/// change are fixed. Sparse least squares by Ceres (SPARSE_NORMAL_CHOLESKY of SuiteSparse), one thread. The result
/// keeps the law of `boxes` (may be null) and every motion is asked for in `world`: around one that is not valid the
/// change is halved, down to the path as given; where even its parts, checked at other fractions, are not valid, the
/// given path is returned. So never a path worse in validity. clearances: may be empty. Deterministic.
Smoothed smooth(const JointPath& path, const Eigen::VectorXd& weights, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const World& world, const FollowedBoxes* boxes,
                const Clearances& clearances, const SmoothSettings& settings);

}  // namespace opponens::motion
