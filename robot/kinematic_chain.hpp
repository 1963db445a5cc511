// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// How n joints of one planning group carry one link T (the tip), everything else at rest: what inverse kinematics
/// solves. Fixed joints, and joints that the group does not drive, are multiplied into the moving ones.
struct KinematicChain {
  struct Joint {
    Eigen::Isometry3d X_PJ;  ///< from the moving joint before it (or the root); the joint's axis is z of J
    bool revolute = true;    ///< or prismatic
    int index = 0;           ///< into the group's positions; several joints share one where they mimic it
    double multiplier = 1.0;
    double offset = 0.0;  ///< its position is multiplier q[index] + offset, rad or m
  };
  std::vector<Joint> joints;  ///< root first
  Eigen::Isometry3d X_JT;     ///< tip in the last joint's frame
  Eigen::VectorXd lower;      ///< [n] rad or m
  Eigen::VectorXd upper;      ///< [n]
  Eigen::VectorXd rest;       ///< [n] where joints stay that do not move the tip

  /// [n] whether the tip moves with a position.
  Eigen::Array<bool, Eigen::Dynamic, 1> moving() const;
  /// [n] whether 2 pi more of a position leave the tip where it is: it drives revolute joints by whole multipliers.
  Eigen::Array<bool, Eigen::Dynamic, 1> turns() const;
};

/// The chain of a group to a link. rest: [d] positions of the joints outside the group; empty: nearest to zero. Throws
/// std::invalid_argument when no joint of the group moves the link.
KinematicChain kinematic_chain(const RobotModel& robot, const PlanningGroup& group, int tip,
                               const Eigen::VectorXd& rest = {});

/// Pose of the tip in the root frame. q: [n] positions of the group.
Eigen::Isometry3d tip_pose(const KinematicChain& chain, const Eigen::Ref<const Eigen::VectorXd>& q);

/// The same with the geometric Jacobian [angular; linear], about the tip's origin, in R; jacobian is resized to
/// [6 x n].
Eigen::Isometry3d tip_pose(const KinematicChain& chain, const Eigen::Ref<const Eigen::VectorXd>& q,
                           Eigen::Matrix<double, 6, Eigen::Dynamic>& jacobian);

/// What turns pose a into pose b: [rotation vector rad; translation m], in the root frame.
Eigen::Matrix<double, 6, 1> pose_error(const Eigen::Isometry3d& X_RA, const Eigen::Isometry3d& X_RB);

/// Appends to solutions ([n] each) every copy of them that differs by whole turns and is inside the limits.
void add_turns(const KinematicChain& chain, std::vector<Eigen::VectorXd>& solutions);

}  // namespace opponens::robot
