// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/ur_closed_form.hpp"

#include <algorithm>
#include <cmath>

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kNoLength = 1e-10;  ///< m: a direction is taken from nothing shorter

/// In the plane of the arm, from axis 2: x1 = (c1, s1, 0) and z0.
double along(const UrShoulder& shoulder, const Eigen::Ref<const Vector3d>& v) {
  return shoulder.c1 * v.x() + shoulder.s1 * v.y();
}

}  // namespace

UrPose operator*(const UrPose& a, const UrPose& b) { return {a.R * b.R, a.p + a.R * b.p}; }

UrPose inverse(const UrPose& X) { return {X.R.transpose(), -(X.R.transpose() * X.p)}; }

UrPose ur_pose(const UrArm& arm, const Vector6d& theta) {
  const double c1 = std::cos(theta[0]), s1 = std::sin(theta[0]);
  const double c5 = std::cos(theta[4]), s5 = std::sin(theta[4]);
  const double c6 = std::cos(theta[5]), s6 = std::sin(theta[5]);
  const double c234 = std::cos(theta[1] + theta[2] + theta[3]), s234 = std::sin(theta[1] + theta[2] + theta[3]);
  const double x = arm.a2 * std::cos(theta[1]) + arm.a3 * std::cos(theta[1] + theta[2]) + arm.d5 * s234;
  const double y = arm.a2 * std::sin(theta[1]) + arm.a3 * std::sin(theta[1] + theta[2]) - arm.d5 * c234;
  Eigen::Matrix3d plane;  // x and y of the arm's plane, and the axis u of joints 2, 3, 4
  plane << c1, 0, s1, s1, 0, -c1, 0, 1, 0;
  Eigen::Matrix3d wrist;                                                         // frame 6 in it
  wrist << c234 * c5 * c6 - s234 * s6, -c234 * c5 * s6 - s234 * c6, -c234 * s5,  //
      s234 * c5 * c6 + c234 * s6, -s234 * c5 * s6 + c234 * c6, -s234 * s5,       //
      s5 * c6, -s5 * s6, c5;
  return {plane * wrist, plane * Vector3d(x, y, arm.d4)};
}

// The wrist's component along u = (s1, -c1, 0) is d4.
UrShoulder ur_shoulder(const UrArm& arm, const UrPose& X, double side, double free1) {
  const double square = X.p.x() * X.p.x() + X.p.y() * X.p.y();
  const double radius = std::sqrt(square);
  const double miss = std::max(0.0, std::abs(arm.d4) - radius);
  if (radius < kNoLength) return {std::cos(free1), std::sin(free1), free1, miss};
  const double d = std::clamp(arm.d4, -radius, radius);
  const double h = side * std::sqrt((radius - d) * (radius + d));
  const double c1 = (h * X.p.x() - d * X.p.y()) / square;
  const double s1 = (h * X.p.y() + d * X.p.x()) / square;
  return {c1, s1, std::atan2(s1, c1), miss};
}

// Row u' R of the rotation is (s5 c6, -s5 s6, c5).
UrWrist ur_wrist(const UrArm& arm, const UrPose& X, const UrShoulder& shoulder, double side) {
  const double wx = shoulder.s1 * X.R(0, 0) - shoulder.c1 * X.R(1, 0);
  const double wy = shoulder.s1 * X.R(0, 1) - shoulder.c1 * X.R(1, 1);
  const double sine = std::sqrt(wx * wx + wy * wy);
  if (sine < kParallelWrist) return ur_wrist_at(arm, X, shoulder, side, 1.0, 0.0);
  return ur_wrist_at(arm, X, shoulder, side, side * wx / sine, -side * wy / sine);
}

UrWrist ur_wrist_at(const UrArm& arm, const UrPose& X, const UrShoulder& shoulder, double side, double c6, double s6) {
  const Vector3d w = (shoulder.s1 * X.R.row(0) - shoulder.c1 * X.R.row(1)).transpose();
  UrWrist wrist;
  wrist.sine = std::sqrt(w.x() * w.x() + w.y() * w.y());
  wrist.theta5 = side * std::atan2(wrist.sine, w.z());
  wrist.theta6 = std::atan2(s6, c6);
  const Vector3d z4 = -(s6 * X.R.col(0) + c6 * X.R.col(1));  // axis 5: (s234, -c234) in the plane
  const double s234 = along(shoulder, z4);
  const double c234 = -z4.z();
  wrist.theta234 = std::atan2(s234, c234);
  wrist.x = along(shoulder, X.p) - arm.d5 * s234;
  wrist.y = X.p.z() + arm.d5 * c234;
  return wrist;
}

UrWrist ur_wrist_extreme(const UrArm& arm, const UrPose& X, const UrShoulder& shoulder, double wrist_side,
                         double side) {
  const double x = along(shoulder, X.p);
  const double y = X.p.z();
  const double length = std::hypot(x, y);
  const double sense = (arm.d5 < 0.0 ? side : -side) / std::max(length, kNoLength);  // of axis 5, so that d5 z4 is it
  const double zx = length > kNoLength ? sense * x : 1.0;
  const double zy = length > kNoLength ? sense * y : 0.0;
  const double s6 = -(along(shoulder, X.R.col(0)) * zx + X.R(2, 0) * zy);
  const double c6 = -(along(shoulder, X.R.col(1)) * zx + X.R(2, 1) * zy);
  const double norm = std::hypot(s6, c6);
  return ur_wrist_at(arm, X, shoulder, wrist_side, c6 / norm, s6 / norm);
}

UrElbow ur_elbow(const UrArm& arm, const UrWrist& wrist, double side, double free2) {
  const double square = wrist.x * wrist.x + wrist.y * wrist.y;
  const double cosine = (square - arm.a2 * arm.a2 - arm.a3 * arm.a3) / (2.0 * arm.a2 * arm.a3);
  const double c3 = std::clamp(cosine, -1.0, 1.0);
  const double s3 = side * std::sqrt((1.0 - c3) * (1.0 + c3));
  const double near = arm.a2 + arm.a3 * c3;
  const double across = arm.a3 * s3;
  const double miss = c3 == cosine ? 0.0 : std::abs(std::sqrt(square) - std::abs(near));
  const double theta3 = std::atan2(s3, c3);
  if (square < kNoLength * kNoLength) return {free2, theta3, miss};
  return {std::atan2(near * wrist.y - across * wrist.x, near * wrist.x + across * wrist.y), theta3, miss};
}

Vector6d ur_angles(const UrShoulder& shoulder, const UrWrist& wrist, const UrElbow& elbow) {
  Vector6d theta;
  theta << shoulder.theta1, elbow.theta2, elbow.theta3, wrist.theta234 - elbow.theta2 - elbow.theta3, wrist.theta5,
      wrist.theta6;
  return theta;
}

}  // namespace opponens::robot
