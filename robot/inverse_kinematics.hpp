// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Analytic inverse kinematics of an arm of the UR family, by the screw axes of the model's own zero pose, so that it
/// needs no table of robots. Joints 1, 5, 6 and 3 each follow from an equation A cos q + B sin q = C (two roots), the
/// others from plane geometry (Paden-Kahan subproblems: Murray, Li and Sastry 1994, section 3.3). A URDF prints its
/// angles with few digits, so that the axes are parallel or perpendicular to about 1e-9 only: every solution is refined
/// on the exact kinematics and returned only when it meets the pose within 1e-10 (m and rad). Thread-safe.
class ArmKinematics {
 public:
  /// Checks that the arm group of the model is a UR-like chain (6 revolute joints: axis 2, 3, 4 parallel; 1 and 5
  /// perpendicular to them; 6 meets 5 at a right angle); throws std::invalid_argument saying what differs otherwise.
  explicit ArmKinematics(const RobotModel& robot);

  /// All arm configurations [6] rad inside the limits that bring the palm H to X_RH: up to eight branches, each wrapped
  /// by 2 pi into every turn that the limits allow. Empty: out of reach. At a wrist singularity joint 6 is set to the
  /// middle of its limits (a stated choice among infinitely many), or, where the elbow cannot reach then, to the
  /// positions at which it is bent most and least. Throws std::invalid_argument unless X_RH is finite.
  std::vector<Eigen::VectorXd> solve(const Eigen::Isometry3d& X_RH) const;

  /// The branches alone, at most eight: each joint in the turn nearest to the middle of its limits.
  std::vector<Eigen::VectorXd> branches(const Eigen::Isometry3d& X_RH) const;

 private:
  static constexpr double kPoseTolerance = 5e-11;  ///< m and rad: matrix entries then agree within 1e-10
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  struct Joint6 {
    Eigen::Isometry3d X_PJ;  ///< from the joint before (or the root), fixed joints included
    Eigen::Vector3d axis;    ///< unit, in J
    Eigen::Vector3d w;       ///< unit axis in R at the zero pose
    Eigen::Vector3d p;       ///< a point of the axis in R at the zero pose
    int index;               ///< in q_a
    double lower;
    double upper;
  };

  struct Search {
    const Eigen::Isometry3d& X_RH;
    Eigen::Isometry3d X;          ///< X_RH X_RH(0)^-1
    std::vector<Vector6d> found;  ///< distinct solutions
  };

  void read_chain(const RobotModel& robot);
  void check_family() const;
  std::vector<Vector6d> roots(const Eigen::Isometry3d& X_RH) const;
  void wrist_roots(Search& search, double q1) const;
  bool singular_wrist_roots(Search& search, Vector6d q) const;
  bool elbow_roots(Search& search, Vector6d q) const;
  double refine(const Eigen::Isometry3d& X_RH, Vector6d& q) const;
  Vector6d step(const Eigen::Isometry3d& X_RH, const Vector6d& q, double& residual) const;
  bool settle(const Eigen::Isometry3d& X_RH, Vector6d& q) const;

  std::array<Joint6, 6> joints_;
  Eigen::Isometry3d X_6H_;  ///< palm in the frame that joint 6 moves
  Eigen::Isometry3d X_RH_zero_;
  Eigen::Vector3d wrist_;  ///< where axes 5 and 6 meet, in R at the zero pose
};

}  // namespace opponens::robot
