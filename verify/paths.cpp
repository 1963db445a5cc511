// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/paths.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "verify/collision_bodies.hpp"
#include "verify/palm_pose.hpp"

namespace opponens::verify {
namespace {

constexpr int kReportedCollisions = 10;

void check_configuration(const JointPath& path, Eigen::Index row, const Eigen::VectorXd& expected,
                         const std::string& name, double tolerance, Verdict& verdict) {
  if (expected.size() != path.waypoints.cols()) {
    verdict.fail("the claimed " + name + " has " + std::to_string(expected.size()) + " joints, the path " +
                 std::to_string(path.waypoints.cols()));
    return;
  }
  const double error = (path.waypoints.row(row).transpose() - expected).cwiseAbs().maxCoeff();
  if (!(error <= tolerance)) {
    verdict.fail("waypoint " + std::to_string(row) + " differs from the " + name + " by " + number(error) + " rad");
  }
}

/// Shape, names and numbers; the rest needs them.
bool check_form(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot, Verdict& verdict) {
  if (path.waypoints.rows() < 1 || path.waypoints.cols() != robot.dof() || !path.waypoints.allFinite()) {
    verdict.fail("the path has no waypoint, or not one finite number per joint");
    return false;
  }
  if (path.joint_names != robot.joint_names()) {
    verdict.fail("the path's joints are not the robot's, or in another order");
    return false;
  }
  if (claim.grasp.has_value() != (claim.closing_from >= 0) || claim.closing_from >= path.waypoints.rows()) {
    verdict.fail("the closing segment begins at waypoint " + std::to_string(claim.closing_from) + " of " +
                 std::to_string(path.waypoints.rows()));
    return false;
  }
  return true;
}

void check_limits(const JointPath& path, const robot::RobotModel& robot, double tolerance, Verdict& verdict) {
  // Limits are a box: what holds at the waypoints holds between them.
  for (Eigen::Index i = 0; i < path.waypoints.rows(); ++i) {
    for (Eigen::Index j = 0; j < path.waypoints.cols(); ++j) {
      const double q = path.waypoints(i, j);
      if (q < robot.lower()[j] - tolerance || q > robot.upper()[j] + tolerance) {
        verdict.fail("waypoint " + std::to_string(i) + ": joint " + path.joint_names[static_cast<std::size_t>(j)] +
                     " = " + number(q) + " rad is outside [" + number(robot.lower()[j]) + ", " +
                     number(robot.upper()[j]) + "]");
      }
    }
  }
}

/// The walk along the path.
class Walk {
 public:
  Walk(const PathClaim& claim, const robot::RobotModel& robot, const robot::Scene& scene,
       const PathCheckSettings& settings, Verdict& verdict)
      : claim_(claim), settings_(settings), verdict_(verdict), bodies_(robot, scene) {
    for (const std::string& link : claim.contact_links) contacts_.emplace(link, claim.object);
  }

  void visit(const Eigen::VectorXd& q, const std::string& where, bool closing, bool with_clearance) {
    bodies_.set(q);
    ++verdict_.checked;
    bool free = true;
    for (const CollisionBodies::Pair& pair : bodies_.colliding()) {
      if (closing && contacts_.count(pair) == 1) {
        check_depth(pair, where);
        continue;
      }
      free = false;
      note_clearance({0.0, pair});
      report("collision of " + pair.first + " and " + pair.second + " " + where);
    }
    if (free && with_clearance)
      note_clearance(bodies_.clearance(closing ? contacts_ : none_, verdict_.worst_clearance));
  }

 private:
  void note_clearance(const CollisionBodies::Clearance& found) {
    if (found.distance >= verdict_.worst_clearance) return;
    verdict_.worst_clearance = found.distance;
    verdict_.worst_pair = found.pair;
  }

  void check_depth(const CollisionBodies::Pair& pair, const std::string& where) {
    const double depth = bodies_.penetration(pair.first, pair.second);
    verdict_.worst_contact_penetration = std::max(verdict_.worst_contact_penetration, depth);
    if (depth > settings_.max_penetration) {
      report("contact of " + pair.first + " and " + pair.second + " is " + number(1e3 * depth) + " mm deep " + where);
    }
  }

  void report(const std::string& reason) {
    verdict_.ok = false;
    if (reported_++ < kReportedCollisions) verdict_.reasons.push_back(reason);
  }

  const PathClaim& claim_;
  const PathCheckSettings& settings_;
  Verdict& verdict_;
  CollisionBodies bodies_;
  std::set<CollisionBodies::Pair> contacts_;
  const std::set<CollisionBodies::Pair> none_;
  int reported_ = 0;
};

double weighted_length(const Eigen::VectorXd& weights, const Eigen::VectorXd& step) {
  return std::sqrt((weights.array() * step.array().square()).sum());
}

void walk_path(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot,
               const PathCheckSettings& settings, Walk& walk) {
  const auto every =
      static_cast<Eigen::Index>(std::max(1.0, std::round(settings.clearance_spacing / settings.spacing)));
  walk.visit(path.waypoints.row(0).transpose(), "at waypoint 0", claim.closing_from == 0, true);
  for (Eigen::Index i = 1; i < path.waypoints.rows(); ++i) {
    const Eigen::VectorXd from = path.waypoints.row(i - 1).transpose();
    const Eigen::VectorXd step = path.waypoints.row(i).transpose() - from;
    const auto count = std::max<Eigen::Index>(
        1, static_cast<Eigen::Index>(std::ceil(weighted_length(robot.weights(), step) / settings.spacing)));
    const bool closing = claim.closing_from >= 0 && i > claim.closing_from;
    const std::string between = "between waypoints " + std::to_string(i - 1) + " and " + std::to_string(i) + " at ";
    for (Eigen::Index k = 0; k < count; ++k) {
      // The middles of the parts: not the fractions that a planner's own check has been to.
      const double fraction = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      walk.visit(from + fraction * step, between + number(fraction), closing, k % every == 0);
    }
    walk.visit(path.waypoints.row(i).transpose(), "at waypoint " + std::to_string(i), closing, true);
  }
}

void check_ends(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot,
                const robot::Scene& scene, const PathCheckSettings& settings, Verdict& verdict) {
  const Eigen::Index last = path.waypoints.rows() - 1;
  const Eigen::Index pregrasp = claim.closing_from >= 0 ? claim.closing_from : last;
  check_configuration(path, 0, claim.start, "start", settings.tolerance, verdict);
  check_configuration(path, pregrasp, claim.goal, "pre-grasp", settings.tolerance, verdict);
  if (claim.grasp) check_configuration(path, last, *claim.grasp, "grasp", settings.tolerance, verdict);
  const Eigen::Isometry3d X_RW = scene.X_WR.inverse();
  if (claim.X_WH_pregrasp) {
    check_palm(robot, path.waypoints.row(pregrasp).transpose(), X_RW * *claim.X_WH_pregrasp, "the path's pre-grasp",
               settings.pose_tolerance, verdict);
  }
  if (claim.X_WH_grasp) {
    check_palm(robot, path.waypoints.row(last).transpose(), X_RW * *claim.X_WH_grasp, "the path's end",
               settings.pose_tolerance, verdict);
  }
}

}  // namespace

Verdict check_path(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot,
                   const robot::Scene& scene, const PathCheckSettings& settings) {
  require(settings.spacing > 0.0 && settings.clearance_spacing >= settings.spacing && settings.max_penetration >= 0.0 &&
              settings.tolerance >= 0.0 && settings.pose_tolerance >= 0.0,
          "PathCheckSettings: spacing must be positive, clearance_spacing at least that, the others >= 0");
  Verdict verdict;
  if (!check_form(path, claim, robot, verdict)) return verdict;
  check_ends(path, claim, robot, scene, settings, verdict);
  check_limits(path, robot, std::max(settings.tolerance, 1e-9), verdict);
  Walk walk(claim, robot, scene, settings, verdict);
  walk_path(path, claim, robot, settings, walk);
  return verdict;
}

}  // namespace opponens::verify
