// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/result.hpp"
#include "robot/kinematic_chain.hpp"

namespace opponens::robot {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A pose as its two parts.
struct UrPose {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;  ///< m
};

/// An arm of the UR family with axes made exactly parallel and perpendicular, in angles theta of its own:
///   X_RT = X_R0 U(theta) X_6T,  theta_i = sign_i q_i + zero_i,
///   U = Rz(t1) Rx(pi/2) Rz(t2) Tx(a2) Rz(t3) Tx(a3) Rz(t4) Tz(d4) Rx(pi/2) Rz(t5) Tz(d5) Rx(-pi/2) Rz(t6),
/// the published Denavit-Hartenberg form with d1 and d6 left to the two fixed poses: frame 0 is where axes 1 and 2
/// meet, frame 6 where 5 and 6 meet.
struct UrArm {
  double a2 = 0.0;  ///< m, > 0, upper arm
  double a3 = 0.0;  ///< m, > 0, forearm
  double d4 = 0.0;  ///< m, shoulder's offset along axes 2, 3, 4
  double d5 = 0.0;  ///< m, axis 4 to axis 6
  Vector6d sign = Vector6d::Ones();
  Vector6d zero = Vector6d::Zero();  ///< rad
  UrPose X_R0;
  UrPose X_6T;
};

/// The ideal arm of a chain. Failure (not_found), saying what differs: six revolute joints, each of a position of its
/// own; axes 2, 3, 4 parallel, 1 and 5 perpendicular to them and meeting 2 and 4; 6 meeting 5 at a right angle. Each
/// within 1e-6 (m and rad).
Result<UrArm> ideal_ur_arm(const KinematicChain& chain);

UrPose operator*(const UrPose& a, const UrPose& b);
UrPose inverse(const UrPose& X);

/// U(theta).
UrPose ur_pose(const UrArm& arm, const Vector6d& theta);

// The closed form for U(theta) = X, in three stages of two roots each, named by a side +1 or -1. Sines and cosines come
// from lengths and directions, so that nothing is lost near a singularity and only the final angles need an arc tangent
// (the equations are Hawkins's 2013, "Analytic inverse kinematics for the Universal Robots UR-5/UR-10 arms", but for
// that). miss: m or rad, by how much the nearest position fails where there is no root; 0 where there is one.

struct UrShoulder {
  double c1, s1;
  double theta1;
  double miss;
};
/// Cosine and sine of joint 1 from the wrist's distance to axis 1; free1: used when the wrist lies on that axis.
UrShoulder ur_shoulder(const UrArm& arm, const UrPose& X, double side, double free1);

struct UrWrist {
  double theta5, theta6;
  double theta234;  ///< t2 + t3 + t4
  double x, y;      ///< m, axis 4 in the arm's plane, from axis 2
  double sine;      ///< of the angle between axes 4 and 6, >= 0
};
UrWrist ur_wrist(const UrArm& arm, const UrPose& X, const UrShoulder& shoulder, double side);
/// Sine below which axes 4 and 6 count as parallel: then joint 6 is free, the others following. The pose error is that
/// sine.
inline constexpr double kParallelWrist = 1e-11;
/// The wrist with a chosen joint 6.
UrWrist ur_wrist_at(const UrArm& arm, const UrPose& X, const UrShoulder& shoulder, double side, double c6, double s6);
/// The two positions of joint 6, given one with axes 4 and 6 parallel, that bring axis 4 nearest to axis 2 (side -1)
/// or farthest from it (side +1).
UrWrist ur_wrist_extreme(const UrArm& arm, const UrPose& X, const UrShoulder& shoulder, double wrist_side, double side);

struct UrElbow {
  double theta2, theta3;
  double miss;
};
/// free2: used when axis 4 lies on axis 2.
UrElbow ur_elbow(const UrArm& arm, const UrWrist& wrist, double side, double free2);

Vector6d ur_angles(const UrShoulder& shoulder, const UrWrist& wrist, const UrElbow& elbow);

}  // namespace opponens::robot
