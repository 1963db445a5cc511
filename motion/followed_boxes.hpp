// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "core/synergies.hpp"

namespace opponens::motion {

/// Distance of a configuration from what its hand (or hands, in their product box) should follow: scaled units (rad
/// where the box's scale is 1), >= 0, convex in q. So along a straight motion it is largest at an end.
using BoxDistance = std::function<double(const Eigen::VectorXd& q)>;

/// Of the hand's joints from a synergy box: |q_h ./ scale - its projection|. hand: index range in q.
BoxDistance box_distance(const SynergyBox& box, const PlanningGroup& hand);

/// The boxes that a planned path followed, and how far it strayed. The law of all that is done after planning: up to
/// some waypoint every waypoint is within start_limit of the start's box, from it on within goal_limit of the goal's;
/// as the distances are convex, so is every point between them. No part is ever further from the box it follows than
/// the planned path was.
struct FollowedBoxes {
  BoxDistance start;
  BoxDistance goal;
  double start_limit = 0.0;  ///< scaled units, largest distance on the planned path's start part
  double goal_limit = 0.0;   ///< the same of its goal part
  Eigen::VectorXd bridge;    ///< [d] rad, where the planned path changed from one to the other: within both limits
};

/// planned: rows up to bridge_row followed the start's box, rows from it on the goal's.
FollowedBoxes followed_boxes(const Eigen::MatrixXd& planned, int bridge_row, BoxDistance start, BoxDistance goal);

/// A row where waypoints [N x d] may change boxes so that the law holds, with 1e-9 for rounding; nullopt: they break
/// it.
std::optional<int> change_row(const FollowedBoxes& boxes, const Eigen::MatrixXd& waypoints);

/// The point nearest to q, on the straight way from q to the bridge with q's arm, that is within both limits. kept:
/// index range in q that stays as it is (the arms).
Eigen::VectorXd within_both(const FollowedBoxes& boxes, const Eigen::VectorXd& q, const PlanningGroup& kept);

}  // namespace opponens::motion
