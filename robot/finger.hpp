// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// A finger as retargeting sees it, all in the palm frame.
struct Finger {
  int link = -1;
  Eigen::Vector3d p_L;        ///< tip point in its link, m
  Eigen::Vector3d base;       ///< the last joint origin towards the tip that the finger's joints do not move, m
  double length = 0.0;        ///< from the base joint to joint to the tip, m
  std::vector<int> moved_by;  ///< indices into q of the hand joints that move the tip's link
};

Finger finger_of(const RobotModel& hand, const SurfacePoint& tip);

/// Tip positions [3 x T] m in the palm frame. q: [d x T] rad.
Eigen::Matrix3Xd tip_path(const RobotModel& hand, const Finger& finger, const Eigen::MatrixXd& q);

}  // namespace opponens::robot
