// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/path.hpp"
#include "robot/motion_bound.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"
#include "verify/bodies.hpp"
#include "verify/path_proof.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {

struct PathCheckSettings {
  ProofSettings proof;
  double tolerance = 1e-9;       ///< rad, of start, pre-grasp and grasp
  double pose_tolerance = 1e-6;  ///< m and rad, of the palm at pre-grasp and grasp
};

/// What a path claims of a hand.
struct HandClaim {
  std::optional<Eigen::Isometry3d> X_WH_pregrasp;  ///< palm in the world that the pre-grasp asks for
  std::optional<Eigen::Isometry3d> X_WH_grasp;     ///< and the grasp
  std::string object;                              ///< scene body that the contacts touch
  std::set<std::string> contact_links;  ///< of the grasp's stored contacts: may touch the object while closing
};

/// What a path claims.
struct PathClaim {
  Eigen::VectorXd start;                 ///< [d] rad
  Eigen::VectorXd goal;                  ///< [d] rad, the pre-grasp with the arms' solutions
  std::optional<Eigen::VectorXd> grasp;  ///< [d] rad, the path's end when it has a closing segment
  Eigen::Index closing_from = -1;        ///< waypoint at which that segment begins (the pre-grasp)
  /// One for each of RobotModel::arms(), in their order; empty: nothing of the palms is claimed, and nothing may touch.
  std::vector<HandClaim> hands{};
};

/// Re-checks paths of one robot in one scene, whose trees are built once: joint names and limits, ends, the palms'
/// poses there, that the links in contact are below the palm that claims them, and, for the whole motion and not at
/// samples of it, that every pair of bodies that must not touch keeps the clearance and that the closing segment's
/// contacts stay below their depth (PathProof). What the proof cannot show fails. One reason per pair of bodies, at its
/// worst place; at most ten of them.
class PathChecker {
 public:
  /// Both are referred to and must outlive it.
  PathChecker(const robot::RobotModel& robot, const robot::Scene& scene);

  /// Not from several threads at once: it moves the bodies.
  Verdict check(const JointPath& path, const PathClaim& claim, const PathCheckSettings& settings = {});

 private:
  const robot::RobotModel& robot_;
  const robot::Scene& scene_;
  robot::MotionBound bound_;
  Bodies bodies_;
};

}  // namespace opponens::verify
