// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The ideal UR arm of a chain: its dimensions from the screw axes of the zero pose.
#include <array>
#include <cmath>

#include "robot/ur_closed_form.hpp"

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kFamilyTolerance = 1e-6;  ///< m and rad: digits printed in URDFs give 1e-9

/// A joint's axis at the zero pose, in R.
struct Axis {
  Vector3d w;  ///< unit
  Vector3d p;  ///< a point of it
};
using Axes = std::array<Axis, 6>;

/// Why six axes are none of the UR family; nullptr where they are.
const char* family_fault(const Axes& axes) {
  const auto& [j1, j2, j3, j4, j5, j6] = axes;
  const auto small = [](double value) { return std::abs(value) < kFamilyTolerance; };
  const auto flat = [&w = j2.w](const Vector3d& v) { return (v - v.dot(w) * w).eval(); };
  if (!small(j2.w.cross(j3.w).norm()) || !small(j2.w.cross(j4.w).norm()))
    return "the axes of joints 2, 3 and 4 are not parallel";
  if (!small(j1.w.dot(j2.w))) return "the axes of joints 1 and 2 are not perpendicular";
  if (!small(j5.w.dot(j4.w))) return "the axes of joints 4 and 5 are not perpendicular";
  if (!small(j6.w.dot(j5.w))) return "the axes of joints 5 and 6 are not perpendicular";
  if (!small((j6.p - j5.p).dot(j5.w.cross(j6.w)))) return "the axes of joints 5 and 6 do not meet";
  if (!small((j2.p - j1.p).dot(j1.w.cross(j2.w)))) return "the axes of joints 1 and 2 do not meet";
  if (!small(flat(j5.p - j4.p).dot(j2.w.cross(j5.w)))) return "the axes of joints 4 and 5 do not meet";
  if (small(flat(j3.p - j2.p).norm()) || small(flat(j4.p - j3.p).norm())) return "upper arm or forearm has no length";
  return nullptr;
}

/// Part of v across the unit vector, made a unit vector.
Vector3d across(const Vector3d& v, const Vector3d& unit) { return (v - v.dot(unit) * unit).normalized(); }

UrArm arm_of(const Axes& axes, const UrPose& X_RT) {
  const auto& [j1, j2, j3, j4, j5, j6] = axes;
  const Vector3d u = j2.w;
  const Vector3d z = across(j1.w, u);
  const Vector3d x = z.cross(u);
  const Vector3d origin = j1.p + (j2.p - j1.p).dot(z) * z;
  const auto angle = [&](const Vector3d& v) { return std::atan2(v.dot(z), v.dot(x)); };  // in the arm's plane
  const auto length = [&](const Vector3d& v) { return std::hypot(v.dot(z), v.dot(x)); };
  UrArm arm;
  arm.a2 = length(j3.p - j2.p);
  arm.a3 = length(j4.p - j3.p);
  const Vector3d z4 = across(j5.w, u);
  const Vector3d z6 = across(j6.w, z4);
  const Vector3d wrist = j6.p + (j5.p - j6.p).dot(z6) * z6;
  arm.d4 = (wrist - origin).dot(u);
  arm.d5 = (wrist - j4.p).dot(z4);
  const double t2 = angle(j3.p - j2.p);
  const double t3 = angle(j4.p - j3.p) - t2;
  const double t234 = std::atan2(z4.dot(x), -z4.dot(z));  // z4 = (s234, -c234)
  const Vector3d x234 = std::cos(t234) * x + std::sin(t234) * z;
  arm.sign << 1, 1, j3.w.dot(u) > 0 ? 1 : -1, j4.w.dot(u) > 0 ? 1 : -1, 1, 1;
  arm.zero << 0, t2, t3, t234 - t2 - t3, std::atan2(-z6.dot(x234), z6.dot(u)), 0;
  arm.X_R0.R << x, -u, z;
  arm.X_R0.p = origin;
  arm.X_6T = inverse(arm.X_R0 * ur_pose(arm, arm.zero)) * X_RT;
  return arm;
}

}  // namespace

Result<UrArm> ideal_ur_arm(const KinematicChain& chain) {
  const auto refuse = [](const std::string& what) {
    return failure(FailureCode::not_found, "not an arm of the UR family: " + what);
  };
  if (chain.joints.size() != 6 || chain.lower.size() != 6) {
    return refuse("it has " + std::to_string(chain.joints.size()) + " moving joints and " +
                  std::to_string(chain.lower.size()) + " positions instead of 6 joints");
  }
  if (!chain.moving().all()) return refuse("a joint mimics another");
  Axes axes;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < 6; ++i) {
    const KinematicChain::Joint& joint = chain.joints[i];
    if (!joint.revolute) return refuse("joint " + std::to_string(i + 1) + " is prismatic");
    if (joint.multiplier != 1.0 || joint.offset != 0.0) return refuse("a joint mimics another");
    X = X * joint.X_PJ;
    axes[i] = {X.linear().col(2), X.translation()};
  }
  if (const char* fault = family_fault(axes)) return refuse(fault);
  X = X * chain.X_JT;
  return arm_of(axes, {X.linear(), X.translation()});
}

}  // namespace opponens::robot
