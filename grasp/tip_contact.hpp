// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grasp.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// What a finger touches with: a ball that its link carries at the tip, or one fixed point of its surface.
struct FingerTip {
  std::string finger;
  int link = -1;
  Eigen::Vector3d center_L = Eigen::Vector3d::Zero();  ///< m
  double radius = 0.0;                                 ///< m; 0: a fixed point
  bool exact = true;                                   ///< the ball is the link's surface there, not a fit to it
};

/// How a finger tip may touch.
enum class TipModel {
  ball,         ///< anywhere on the ball at the tip: a rolling finger tip
  fixed_point,  ///< with the hand description's tip point only, as FRoGGeR does (doi:10.1109/ICRA57147.2024.10610519)
};

/// The tips that the description names, in its order. Where a sphere of the link passes within 1 mm of the tip point,
/// that sphere is the ball. Otherwise it touches the surface in the tip point, and its radius, 2 to 20 mm, is the least
/// squares fit to the link's surface samples within 10 mm (for a sample s, a = |s - p|^2 and b = (s - p)'n:
/// a + 2 r b = 0 on the ball, hence r = -sum a b / (2 sum b^2)).
std::vector<FingerTip> finger_tips(const robot::RobotModel& hand, const HandSurface& surface, TipModel model);

/// Where a tip touches the object, by the exact distance.
struct TipTouch {
  double gap;           ///< m between the tip and the object, negative inside
  Eigen::Vector3d p_O;  ///< nearest point of the object's surface
  Eigen::Vector3d n_O;  ///< unit, into the object: against the gradient of the exact distance at the tip
};

/// X_OL: pose of the tip's link. A ball that is exact, or a fixed point: one query of MeshDistance at the centre. A
/// ball that is a fit: the link's dense samples near the tip give a first pair of points, and projecting between object
/// and link surface (von Neumann's alternating projections) sharpens it; the normal is that of the pair.
TipTouch touch(const FingerTip& tip, const HandSurface& surface, const GraspTarget& target,
               const Eigen::Isometry3d& X_OL);

}  // namespace opponens::grasp
