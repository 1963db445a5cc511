// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kFamilyTolerance = 1e-6;  ///< m and rad: digits printed in URDFs give 1e-9
constexpr double kSameSolution = 1e-6;     ///< rad: roots that meet at a singularity
constexpr double kSingularWrist = 1e-8;    ///< sine of joint 5's angle from it
constexpr double kReachSlack = 1e-6;       ///< a cosine beyond 1 by this much is tried: refinement decides

Eigen::Matrix3d turn(const Vector3d& axis, double angle) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

Isometry3d turn_about(const Vector3d& axis, const Vector3d& point, double angle) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = turn(axis, angle);
  X.translation() = point - X.linear() * point;
  return X;
}

/// Angle about the unit axis that turns a into b, both projected onto the plane across the axis. Projected first: near
/// the wrist singularity both are almost along the axis.
double angle_between(const Vector3d& a, const Vector3d& b, const Vector3d& axis) {
  const Vector3d flat_a = a - axis.dot(a) * axis;
  const Vector3d flat_b = b - axis.dot(b) * axis;
  return std::atan2(axis.dot(flat_a.cross(flat_b)), flat_a.dot(flat_b));
}

/// Roots of A cos q + B sin q = C; none beyond reach, the double root twice at its edge.
struct Roots {
  std::array<double, 2> q;
  int count = 0;
};
Roots solve_cosine(double A, double B, double C) {
  const double length = std::hypot(A, B);
  if (length < 1e-12 || std::abs(C) > length * (1.0 + kReachSlack)) return {};
  const double cosine = std::clamp(C / length, -1.0, 1.0);
  const double half = std::atan2(std::sqrt((1.0 - cosine) * (1.0 + cosine)), cosine);
  const double middle = std::atan2(B, A);
  return {{middle - half, middle + half}, 2};
}

bool same(const Eigen::Matrix<double, 6, 1>& a, const Eigen::Matrix<double, 6, 1>& b) {
  for (int i = 0; i < 6; ++i) {
    if (std::abs(std::remainder(a[i] - b[i], kTurn)) > kSameSolution) return false;
  }
  return true;
}

}  // namespace

ArmKinematics::ArmKinematics(const RobotModel& robot) {
  require(robot.arm().count == 6, "an arm of 6 joints is needed, this one has " + std::to_string(robot.arm().count));
  read_chain(robot);
  Isometry3d X = Isometry3d::Identity();
  for (Joint6& joint : joints_) {
    X = X * joint.X_PJ;
    joint.w = X.linear() * joint.axis;
    joint.p = X.translation();
  }
  X_RH_zero_ = X * X_6H_;
  check_family();
  const Joint6& j5 = joints_[4];
  const Joint6& j6 = joints_[5];
  wrist_ = j6.p + (j5.p - j6.p).dot(j6.w) * j6.w;  // the axes cross at a right angle
}

/// From the palm to the root; fixed joints are multiplied into the moving joint after them.
void ArmKinematics::read_chain(const RobotModel& robot) {
  const std::vector<std::string>& names = robot.arm().joint_names;
  Isometry3d X_after = Isometry3d::Identity();
  std::size_t slot = 6;
  for (int i = robot.links()[static_cast<std::size_t>(robot.palm())].joint; i >= 0;) {
    const Joint& joint = robot.description().joints[static_cast<std::size_t>(i)];
    i = robot.links()[static_cast<std::size_t>(joint.parent)].joint;
    if (joint.type == JointType::fixed) {
      X_after = joint.X_PJ * X_after;
      continue;
    }
    const auto name = std::find(names.begin(), names.end(), joint.name);
    require(name != names.end(), "joint '" + joint.name + "' carries the palm but is no arm joint");
    require(joint.type == JointType::revolute, "arm joint '" + joint.name + "' is not revolute");
    (slot == 6 ? X_6H_ : joints_[slot].X_PJ) = slot == 6 ? X_after : X_after * joints_[slot].X_PJ;
    X_after.setIdentity();
    Joint6& own = joints_[--slot];  // the arm has six joints, each met once at most
    own.X_PJ = joint.X_PJ;
    own.axis = joint.axis;
    own.index = static_cast<int>(name - names.begin());
    own.lower = joint.lower;
    own.upper = joint.upper;
  }
  require(slot == 0, "only " + std::to_string(6 - slot) + " of the 6 arm joints carry the palm");
  joints_[0].X_PJ = X_after * joints_[0].X_PJ;
}

void ArmKinematics::check_family() const {
  const auto& [j1, j2, j3, j4, j5, j6] = joints_;
  const auto needed = [](bool condition, const std::string& what) {
    require(condition, "not an arm of the UR family: " + what);
  };
  needed(j2.w.cross(j3.w).norm() < kFamilyTolerance && j2.w.cross(j4.w).norm() < kFamilyTolerance,
         "the axes of joints 2, 3 and 4 are not parallel");
  needed(std::abs(j1.w.dot(j2.w)) < kFamilyTolerance, "the axes of joints 1 and 2 are not perpendicular");
  needed(std::abs(j5.w.dot(j4.w)) < kFamilyTolerance, "the axes of joints 4 and 5 are not perpendicular");
  needed(std::abs(j6.w.dot(j5.w)) < kFamilyTolerance, "the axes of joints 5 and 6 are not perpendicular");
  needed(std::abs((j6.p - j5.p).dot(j5.w.cross(j6.w))) < kFamilyTolerance, "the axes of joints 5 and 6 do not meet");
  const auto flat = [&](const Vector3d& v) { return (v - v.dot(j2.w) * j2.w).eval(); };
  needed(std::abs((j2.p - j1.p).dot(j1.w.cross(j2.w))) < kFamilyTolerance, "the axes of joints 1 and 2 do not meet");
  needed(std::abs(flat(j5.p - j4.p).dot(j2.w.cross(j5.w))) < kFamilyTolerance,
         "the axes of joints 4 and 5 do not meet");
  needed(flat(j3.p - j2.p).norm() > kFamilyTolerance && flat(j4.p - j3.p).norm() > kFamilyTolerance,
         "upper arm or forearm has no length");
}

// With u the direction of axes 2, 3, 4, the product e1 .. e6 of turns about the zero pose's axes and M = X_RH(0):
// X_RH = e1 e2 e3 e4 e5 e6 M. Turns about u keep components along u; that yields q1, q5 and q6 one after the other.
std::vector<ArmKinematics::Vector6d> ArmKinematics::roots(const Isometry3d& X_RH) const {
  const Joint6& j1 = joints_[0];
  const Vector3d& u = joints_[1].w;
  Search search{X_RH, X_RH * X_RH_zero_.inverse(), {}};
  // e5 and e6 keep the wrist point: u . e1^-1 X wrist = u . wrist, where e1 turns about w1 through p1.
  const Vector3d r = search.X * wrist_ - j1.p;
  const Vector3d across = r - r.dot(j1.w) * j1.w;
  const double level = u.dot(wrist_ - j1.p) - r.dot(j1.w) * u.dot(j1.w);
  const Roots q1 = solve_cosine(u.dot(across), -u.dot(j1.w.cross(across)), level);
  for (int i = 0; i < q1.count; ++i) wrist_roots(search, q1.q[static_cast<std::size_t>(i)]);
  return search.found;
}

void ArmKinematics::wrist_roots(Search& search, double q1) const {
  const Joint6& j1 = joints_[0];
  const Joint6& j5 = joints_[4];
  const Joint6& j6 = joints_[5];
  const Vector3d& u = joints_[1].w;
  const Eigen::Matrix3d R = turn(j1.w, -q1) * search.X.linear();  // of e2 e3 e4 e5 e6
  // u . R w6 = u . e5 w6 = cos(q5 - middle): by the arc tangent, which stays exact at the wrist singularity.
  const Vector3d d = R * j6.w;
  const double middle = std::atan2(u.dot(j5.w.cross(j6.w)), u.dot(j6.w));
  const double half = std::atan2((d - d.dot(u) * u).norm(), d.dot(u));
  const Vector3d u6 = R.transpose() * u;  // = e6^-1 e5^-1 u
  const bool singular = u6.cross(j6.w).norm() < kSingularWrist;
  for (const double q5 : {middle - half, middle + half}) {
    Vector6d q;
    q << q1, 0, 0, 0, q5, angle_between(u6, turn(j5.w, -q5) * u, j6.w);
    if (!singular || !singular_wrist_roots(search, q)) elbow_roots(search, q);
  }
}

/// Axes 4 and 6 are parallel: joint 6 is free. Its middle, unless the elbow cannot reach then; otherwise the positions
/// at which the elbow is bent most and least. Whether any was a solution.
bool ArmKinematics::singular_wrist_roots(Search& search, Vector6d q) const {
  const auto& [j1, j2, j3, j4, j5, j6] = joints_;
  q[5] = 0.5 * (j6.lower + j6.upper);
  if (elbow_roots(search, q)) return true;
  const Vector3d& u = j2.w;
  const Isometry3d X_1 = turn_about(j1.w, j1.p, -q[0]) * search.X;
  const Vector3d center = X_1 * j6.p - j2.p;
  const Vector3d arm = X_1.linear() * (turn_about(j5.w, j5.p, -q[4]) * j4.p - j6.p);  // joint 4 about axis 6
  const double sense = (X_1.linear() * j6.w).dot(u) > 0.0 ? -1.0 : 1.0;
  bool any = false;
  for (const double side : {-1.0, 1.0}) {
    q[5] = sense * angle_between(arm, side * center, u);
    any = elbow_roots(search, q) || any;
  }
  return any;
}

/// q2, q3, q4 for given q1, q5, q6. Whether any was a solution; new ones are added to the search.
bool ArmKinematics::elbow_roots(Search& search, Vector6d q) const {
  const auto& [j1, j2, j3, j4, j5, j6] = joints_;
  const Vector3d& u = j2.w;
  const Isometry3d planar = turn_about(j1.w, j1.p, -q[0]) * search.X * turn_about(j6.w, j6.p, -q[5]) *
                            turn_about(j5.w, j5.p, -q[4]);  // e2 e3 e4
  const auto flat = [&](const Vector3d& v) { return (v - v.dot(u) * u).eval(); };
  const Vector3d a = flat(j3.p - j2.p);
  const Vector3d b = flat(j4.p - j3.p);
  const Vector3d reach = flat(planar * j4.p - j2.p);
  const double s3 = j3.w.dot(u) > 0.0 ? 1.0 : -1.0;
  const double s4 = j4.w.dot(u) > 0.0 ? 1.0 : -1.0;
  const Roots bend =
      solve_cosine(a.dot(b), a.dot(u.cross(b)), 0.5 * (reach.squaredNorm() - a.squaredNorm() - b.squaredNorm()));
  const Vector3d across = u.unitOrthogonal();
  const double total = angle_between(across, planar.linear() * across, u);
  bool any = false;
  for (int i = 0; i < bend.count; ++i) {
    const double angle3 = bend.q[static_cast<std::size_t>(i)];
    const double angle2 = angle_between(a + turn(u, angle3) * b, reach, u);
    q[1] = angle2;
    q[2] = s3 * angle3;
    q[3] = s4 * (total - angle2 - angle3);
    Vector6d solution = q;
    if (!q.allFinite() || !settle(search.X_RH, solution)) continue;
    any = true;
    const bool known = std::any_of(search.found.begin(), search.found.end(),
                                   [&](const Vector6d& other) { return same(other, solution); });
    if (!known) search.found.push_back(solution);
  }
  return any;
}

std::vector<Eigen::VectorXd> ArmKinematics::branches(const Isometry3d& X_RH) const {
  require(X_RH.matrix().allFinite(), "the palm pose is not finite");
  std::vector<Eigen::VectorXd> result;
  for (const Vector6d& q : roots(X_RH)) {
    Eigen::VectorXd arm(6);
    bool inside = true;
    for (std::size_t i = 0; i < 6; ++i) {
      const Joint6& joint = joints_[i];
      const double middle = 0.5 * (joint.lower + joint.upper);
      const double value = middle + std::remainder(q[static_cast<Eigen::Index>(i)] - middle, kTurn);
      inside = inside && value >= joint.lower - kPoseTolerance && value <= joint.upper + kPoseTolerance;
      arm[joint.index] = std::clamp(value, joint.lower, joint.upper);
    }
    if (inside) result.push_back(std::move(arm));
  }
  return result;
}

std::vector<Eigen::VectorXd> ArmKinematics::solve(const Isometry3d& X_RH) const {
  std::vector<Eigen::VectorXd> result = branches(X_RH);
  for (const Joint6& joint : joints_) {
    const std::size_t count = result.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double q = result[i][joint.index];
      const int first = static_cast<int>(std::ceil((joint.lower - q - kPoseTolerance) / kTurn));
      const int last = static_cast<int>(std::floor((joint.upper - q + kPoseTolerance) / kTurn));
      for (int turns = first; turns <= last; ++turns) {
        if (turns == 0) continue;
        result.push_back(result[i]);
        result.back()[joint.index] = std::clamp(q + turns * kTurn, joint.lower, joint.upper);
      }
    }
  }
  return result;
}

}  // namespace opponens::robot
