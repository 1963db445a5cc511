// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/followed_boxes.hpp"

#include <algorithm>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"

namespace opponens::motion {
namespace {

constexpr double kRounding = 1e-9;  // scaled units

bool near_start(const FollowedBoxes& boxes, const Eigen::VectorXd& q) {
  return boxes.start(q) <= boxes.start_limit + kRounding;
}

bool near_goal(const FollowedBoxes& boxes, const Eigen::VectorXd& q) {
  return boxes.goal(q) <= boxes.goal_limit + kRounding;
}

}  // namespace

BoxDistance box_distance(const SynergyBox& box, const PlanningGroup& hand) {
  require(box.center.size() == hand.count, "box_distance: box and hand differ in the number of joints");
  return [box, first = hand.first, count = hand.count](const Eigen::VectorXd& q) {
    const Eigen::VectorXd q_h = q.segment(first, count);
    return (q_h - analysis::project(box, q_h)).cwiseQuotient(box.scale).norm();
  };
}

FollowedBoxes followed_boxes(const Eigen::MatrixXd& planned, int bridge_row, BoxDistance start, BoxDistance goal) {
  require(bridge_row >= 0 && bridge_row < planned.rows(), "followed_boxes: bridge_row is no row of the path");
  FollowedBoxes boxes{std::move(start), std::move(goal), 0.0, 0.0, planned.row(bridge_row).transpose()};
  for (Eigen::Index i = 0; i < planned.rows(); ++i) {
    const Eigen::VectorXd q = planned.row(i).transpose();
    if (i <= bridge_row) boxes.start_limit = std::max(boxes.start_limit, boxes.start(q));
    if (i >= bridge_row) boxes.goal_limit = std::max(boxes.goal_limit, boxes.goal(q));
  }
  return boxes;
}

std::optional<int> change_row(const FollowedBoxes& boxes, const Eigen::MatrixXd& waypoints) {
  Eigen::Index last = -1;  // of the rows before which all are near the start's box
  while (last + 1 < waypoints.rows() && near_start(boxes, waypoints.row(last + 1).transpose())) ++last;
  Eigen::Index first = waypoints.rows();  // from it on all are near the goal's
  while (first > 0 && near_goal(boxes, waypoints.row(first - 1).transpose())) --first;
  if (last < first) return std::nullopt;
  return static_cast<int>(std::min(last, waypoints.rows() - 1));
}

Eigen::VectorXd within_both(const FollowedBoxes& boxes, const Eigen::VectorXd& q, const PlanningGroup& kept) {
  Eigen::VectorXd safe = boxes.bridge;
  safe.segment(kept.first, kept.count) = q.segment(kept.first, kept.count);
  if (near_start(boxes, q) && near_goal(boxes, q)) return q;
  double low = 0.0;  // share of q that is known to be within both
  double high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    const Eigen::VectorXd between = safe + middle * (q - safe);
    (near_start(boxes, between) && near_goal(boxes, between) ? low : high) = middle;
  }
  return safe + low * (q - safe);
}

}  // namespace opponens::motion
