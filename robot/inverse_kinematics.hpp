// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Analytic inverse kinematics of an arm of the UR family. Built from the model's own joint frames, so that it needs no
/// table of robots; thread-safe.
class ArmKinematics {
 public:
  /// Checks that the arm group of the model is a UR-like chain (6 revolute joints: axis 2, 3, 4 parallel; 1 and 5
  /// perpendicular to them) and reads its dimensions; throws std::invalid_argument saying what differs otherwise.
  explicit ArmKinematics(const RobotModel& robot);

  /// All arm configurations [6] rad inside the limits that bring the palm H to X_RH: up to eight branches, each wrapped
  /// by 2 pi into every turn that the limits allow. Empty: out of reach. At a wrist singularity joint 6 is set to the
  /// middle of its limits (a stated choice among infinitely many).
  std::vector<Eigen::VectorXd> solve(const Eigen::Isometry3d& X_RH) const;

 private:
  Eigen::Isometry3d X_R0_;          ///< DH base in the robot root
  Eigen::Isometry3d X_6H_;          ///< palm in the DH tip frame
  Eigen::Matrix<double, 6, 1> sign_;
  Eigen::Matrix<double, 6, 1> offset_;
  double d1_ = 0, a2_ = 0, a3_ = 0, d4_ = 0, d5_ = 0, d6_ = 0;  ///< m
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
};

}  // namespace opponens::robot
