// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/closing_segment.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "core/require.hpp"
#include "motion/continuous_check.hpp"
#include "motion/edge_check.hpp"
#include "motion/joint_groups.hpp"

namespace opponens::motion {
namespace {

constexpr double kDepthShare = 10.0;  ///< where an answer's depth is not proven, it is asked this much more densely

}  // namespace

World closing_world(const robot::CollisionChecker& free_space, const robot::CollisionChecker& closing,
                    const robot::RobotModel& robot, const std::vector<Contact>& contacts, double resolution,
                    const ContactLimit& contact) {
  std::set<std::string> links;
  for (const Contact& c : contacts) links.insert(c.link);
  const auto touches_right = [&free_space, &closing, links, contact](const Eigen::VectorXd& q) {
    if (!closing.free(q)) return false;
    for (const robot::BodyPair& pair : free_space.colliding_pairs(q)) {
      if (links.count(pair.first) == 0 && links.count(pair.second) == 0) return false;
    }
    return contact.depth == nullptr || (*contact.depth)(q) <= contact.max_depth;
  };
  const auto first_invalid_row = [&free_space, &robot,
                                  touches_right](const robot::ConfigurationBatch& batch) -> std::optional<int> {
    const std::vector<bool> free = free_space.free_rows(batch);
    for (int row = 0; row < batch.rows(); ++row) {
      const Eigen::VectorXd q = batch.row(row).transpose();
      if (!robot.within_limits(q)) return row;
      if (!free[static_cast<std::size_t>(row)] && !touches_right(q)) return row;
    }
    return std::nullopt;
  };
  World world = make_world_by_rows(first_invalid_row, robot.weights(), resolution);
  const ContinuousCheck all = contact.clearance != nullptr ? *contact.clearance : ContinuousCheck(free_space, robot);
  const auto clearance = std::make_shared<const ContinuousCheck>(all.without_contacts(closing, links));
  world.confirm = [clearance, contact, weights = robot.weights(), spacing = Spacing(resolution / kDepthShare)](
                      const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                      std::int64_t& checks) -> std::optional<double> {
    if (const auto near = clearance->first_near(q_from, q_to, checks)) return near;
    if (contact.depth == nullptr) return std::nullopt;
    const double shortest = 1.0 / std::max(1.0, spacings(spacing, weights, q_from, q_to));
    return contact.depth->first_deeper(q_from, q_to, contact.max_depth, shortest, checks);
  };
  return world;
}

namespace {

/// A configuration that makes these motions invalid.
std::optional<Eigen::VectorXd> in_the_way(const Eigen::MatrixXd& waypoints, const World& world) {
  std::int64_t checks = 0;
  for (const MotionCheck* check : {&world.first_invalid, &world.confirm}) {
    for (Eigen::Index i = 1; *check && i < waypoints.rows(); ++i) {
      const Eigen::VectorXd q_from = waypoints.row(i - 1).transpose();
      const Eigen::VectorXd q_to = waypoints.row(i).transpose();
      if (const auto fraction = (*check)(q_from, q_to, checks)) return q_from + *fraction * (q_to - q_from);
    }
  }
  return std::nullopt;
}

}  // namespace

ClosingSegment closing_segment(const Eigen::VectorXd& q_pregrasp, const Eigen::VectorXd& q_grasp,
                               const PlanningGroup& hand, const World& closing) {
  require(q_pregrasp.size() == q_grasp.size() && hand.first + hand.count <= q_grasp.size(),
          "closing_segment: pre-grasp and grasp must be whole configurations of one robot");
  Eigen::VectorXd between = q_grasp;
  between.segment(hand.first, hand.count) = q_pregrasp.segment(hand.first, hand.count);
  Eigen::MatrixXd together(2, q_grasp.size());
  together << q_pregrasp.transpose(), q_grasp.transpose();
  Eigen::MatrixXd arm_first(3, q_grasp.size());
  arm_first << q_pregrasp.transpose(), between.transpose(), q_grasp.transpose();

  const bool distinct = between != q_pregrasp && between != q_grasp;
  std::optional<Eigen::VectorXd> invalid = in_the_way(together, closing);
  if (!invalid) return {together, std::nullopt};
  if (distinct) invalid = in_the_way(arm_first, closing);  // else only the arm or only the hand moves
  if (!invalid) return {arm_first, std::nullopt};
  return {{}, invalid};
}

Result<JointPath> append_closing_segment(const JointPath& path, const Eigen::VectorXd& q_grasp,
                                         const PlanningGroup& hand, const World& closing) {
  require(path.waypoints.rows() > 0, "append_closing_segment: the path is empty");
  const Eigen::Index rows = path.waypoints.rows();
  const Eigen::VectorXd q_pregrasp = path.waypoints.row(rows - 1).transpose();
  const ClosingSegment segment = closing_segment(q_pregrasp, q_grasp, hand, closing);
  if (segment.waypoints.rows() == 0) {
    return failure(FailureCode::invalid_input, "no valid closing segment from the path's end to the grasp");
  }
  JointPath longer{path.joint_names, Eigen::MatrixXd(rows + segment.waypoints.rows() - 1, q_grasp.size())};
  longer.waypoints << path.waypoints, segment.waypoints.bottomRows(segment.waypoints.rows() - 1);
  return longer;
}

}  // namespace opponens::motion
