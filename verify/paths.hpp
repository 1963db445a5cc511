// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/path.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"
#include "verify/verdict.hpp"

namespace opponens::verify {

struct PathCheckSettings {
  double spacing = 0.002;           ///< rad, of checked configurations in the weighted metric
  double clearance_spacing = 0.02;  ///< rad, of those whose clearance is measured too; a multiple of spacing
  double max_penetration = 0.001;   ///< m, of the closing segment's contacts
  double tolerance = 1e-9;          ///< rad, of start, pre-grasp and grasp
  double pose_tolerance = 1e-6;     ///< m and rad, of the palm at pre-grasp and grasp
};

/// What a path claims.
struct PathClaim {
  Eigen::VectorXd start;                           ///< [d] rad
  Eigen::VectorXd goal;                            ///< [d] rad, the pre-grasp with the arm's solution
  std::optional<Eigen::VectorXd> grasp;            ///< [d] rad, the path's end when it has a closing segment
  std::optional<Eigen::Isometry3d> X_WH_pregrasp;  ///< palm in the world that the pre-grasp asks for
  std::optional<Eigen::Isometry3d> X_WH_grasp;     ///< and the grasp
  Eigen::Index closing_from = -1;                  ///< waypoint at which that segment begins (the pre-grasp)
  std::string object;                              ///< scene body that the contacts touch
  std::set<std::string> contact_links;  ///< of the grasp's stored contacts: may touch the object while closing
};

/// Re-checks a path by plain dense sampling with a collision loop of its own (FCL objects made here from the same robot
/// and scene, bounding boxes first, solids by ray crossings): joint names and limits, ends, the palm's poses there,
/// every waypoint and the configurations in the middles of equal parts of at most `spacing` (so between those of a
/// planner that checked at the parts' ends), and on the closing segment the depth of the allowed contacts.
/// worst_clearance is the least distance of any pair that must not touch, over the configurations at
/// clearance_spacing; 0 when anything collides. At most ten collisions are reported one by one.
Verdict check_path(const JointPath& path, const PathClaim& claim, const robot::RobotModel& robot,
                   const robot::Scene& scene, const PathCheckSettings& settings = {});

}  // namespace opponens::verify
