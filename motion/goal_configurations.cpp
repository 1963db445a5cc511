// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/goal_configurations.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/require.hpp"
#include "motion/closing_segment.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {
namespace {

struct Candidate {
  ArmSolution arm;
  double motion;  ///< rad, weighted, pre-grasp to grasp
  double turns;   ///< rad, weighted distance of the grasp from zero
};

/// Whether two arm configurations put the links at the same place.
bool same_pose(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  constexpr double kSame = 1e-6;  // turns
  return ((a - b).array() / (2.0 * std::numbers::pi))
      .unaryExpr([](double turns) { return std::abs(turns - std::round(turns)); })
      .isZero(kSame);
}

/// Pairs of branches, least motion first, without repetitions of one pose by whole turns.
std::vector<Candidate> pair_branches(const std::vector<Eigen::VectorXd>& pregrasps,
                                     const std::vector<Eigen::VectorXd>& grasps, const Eigen::VectorXd& weights) {
  std::vector<Candidate> candidates;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(weights.size());
  for (const Eigen::VectorXd& grasp : grasps) {
    const auto nearest = std::min_element(pregrasps.begin(), pregrasps.end(), [&](const auto& a, const auto& b) {
      return distance(weights, a, grasp) < distance(weights, b, grasp);
    });
    candidates.push_back({{*nearest, grasp}, distance(weights, *nearest, grasp), distance(weights, zero, grasp)});
  }
  // Turned copies of one pair have the same motion up to rounding, so the turns decide before the motion does.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.turns < b.turns; });
  std::vector<Candidate> distinct;
  for (const Candidate& candidate : candidates) {
    const auto copy = std::find_if(distinct.begin(), distinct.end(), [&](const Candidate& other) {
      return same_pose(candidate.arm.q_grasp, other.arm.q_grasp);
    });
    // Near a limit the partner within a turn may be missing: then the copy with the shorter way is the better one.
    if (copy == distinct.end()) {
      distinct.push_back(candidate);
    } else if (candidate.motion < copy->motion - 1e-6) {
      *copy = candidate;
    }
  }
  std::stable_sort(distinct.begin(), distinct.end(),
                   [](const Candidate& a, const Candidate& b) { return a.motion < b.motion; });
  return distinct;
}

std::string first_pair(const robot::CollisionChecker& checker, const Eigen::VectorXd& q) {
  const std::vector<robot::BodyPair> pairs = checker.colliding_pairs(q);
  return pairs.empty() ? "" : pairs.front().first + "-" + pairs.front().second;
}

/// Why q is no part of a closing segment.
std::string closing_fault(const Grasp& grasp, const robot::CollisionChecker& free_space,
                          const robot::CollisionChecker& closing, const ContactLimit& contact,
                          const Eigen::VectorXd& q) {
  std::string pair = first_pair(closing, q);
  for (const robot::BodyPair& touching : free_space.colliding_pairs(q)) {
    const bool in_contact = std::any_of(grasp.contacts.begin(), grasp.contacts.end(), [&](const Contact& c) {
      return c.link == touching.first || c.link == touching.second;
    });
    if (pair.empty() && !in_contact) pair = touching.first + "-" + touching.second;
  }
  if (!pair.empty()) return "closing segment in collision: " + pair;
  const bool too_deep = contact.depth != nullptr && (*contact.depth)(q) > contact.max_depth;
  return too_deep ? "closing segment too deep in the object" : "closing segment nearer to something than the clearance";
}

}  // namespace

Eigen::VectorXd join(const robot::RobotModel& robot, const Eigen::VectorXd& q_arm, const Eigen::VectorXd& q_hand) {
  require(q_arm.size() == robot.arm().count && q_hand.size() == robot.hand().count,
          "join: arm or hand part has the wrong number of joints");
  Eigen::VectorXd q(robot.dof());
  q.segment(robot.arm().first, robot.arm().count) = q_arm;
  q.segment(robot.hand().first, robot.hand().count) = q_hand;
  return q;
}

std::string reach(Grasp& grasp, const robot::RobotModel& robot, const robot::InverseKinematics& kinematics,
                  const Eigen::Isometry3d& X_RO, const robot::CollisionChecker& free_space,
                  const robot::CollisionChecker& closing, double resolution, const ContactLimit& contact) {
  grasp.arm_solutions.clear();
  const auto grasps = kinematics(X_RO * grasp.X_OH, {});
  if (!grasps) return "no inverse kinematics";
  const auto pregrasps = kinematics(X_RO * grasp.X_OH_pregrasp, *grasps);
  if (!pregrasps) return "no inverse kinematics";
  const World world = closing_world(free_space, closing, robot, grasp.contacts, resolution, contact);
  const Eigen::VectorXd weights = robot.weights().segment(robot.arm().first, robot.arm().count);
  std::string pregrasp_reason;
  std::string closing_reason;
  for (const Candidate& candidate : pair_branches(*pregrasps, *grasps, weights)) {
    const Eigen::VectorXd q_pregrasp = join(robot, candidate.arm.q_pregrasp, grasp.q_pregrasp);
    const Eigen::VectorXd q_grasp = join(robot, candidate.arm.q_grasp, grasp.q_grasp);
    if (!robot.within_limits(q_pregrasp) || !robot.within_limits(q_grasp)) {
      if (pregrasp_reason.empty()) pregrasp_reason = "outside the joint limits";
      continue;
    }
    if (!free_space.free(q_pregrasp)) {
      if (pregrasp_reason.empty()) pregrasp_reason = "pre-grasp in collision: " + first_pair(free_space, q_pregrasp);
      continue;
    }
    const ClosingSegment segment = closing_segment(q_pregrasp, q_grasp, robot.hand(), world);
    if (segment.invalid) {
      if (closing_reason.empty()) {
        closing_reason = closing_fault(grasp, free_space, closing, contact, *segment.invalid);
      }
      continue;
    }
    grasp.arm_solutions.push_back(candidate.arm);
    if (static_cast<int>(grasp.arm_solutions.size()) == kMaxArmSolutions) break;
  }
  if (!grasp.arm_solutions.empty()) return "";
  return closing_reason.empty() ? pregrasp_reason : closing_reason;
}

}  // namespace opponens::motion
