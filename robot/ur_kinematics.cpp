// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/ur_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/damped_least_squares.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPoseTolerance = 5e-11;  ///< m and rad: matrix entries then agree within 1e-10
constexpr double kSameSolution = 1e-6;    ///< rad: roots that meet at a singularity
constexpr double kExact = 1e-12;          ///< m and rad: an arm that deviates less is its ideal
constexpr double kSlack = 1e-6;           ///< m: a root missed by less is tried
constexpr double kOutside = 1e-6;    ///< rad: as far outside a limit as noise beside a singularity may put a solution
constexpr double kClamped = 1e-12;   ///< rad: moving a joint this much to its limit needs no correction
constexpr double kUncertain = 10.0;  ///< deviations: a smaller sine leaves joint 6 to the arm's errors
constexpr int kCorrections = 4;
constexpr int kIterations = 60;         ///< of damped least squares, which halve a singular joint's error each
constexpr double kDescentGoal = 1e-13;  ///< m and rad: beside a singularity positions move by its square root

bool same(const Vector6d& a, const Vector6d& b) {
  for (int i = 0; i < 6; ++i) {
    const double apart = std::abs(a[i] - b[i]);
    if (apart > kSameSolution && std::abs(apart - kTurn) > kSameSolution) return false;
  }
  return true;
}

/// The nearest rotation, to first order in what R lacks of one.
Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d square = R.transpose() * R;
  const double lacking = (square - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require(lacking < 1e-6 && R.determinant() > 0.0, "the tip's pose has no rotation matrix");
  if (lacking < 1e-15) return R;
  return 0.5 * R * (3.0 * Eigen::Matrix3d::Identity() - square);
}

}  // namespace

Result<UrKinematics> UrKinematics::of(KinematicChain chain) {
  const Result<UrArm> arm = ideal_ur_arm(chain);
  if (!arm) return tl::make_unexpected(arm.error());
  return UrKinematics(std::move(chain), *arm);
}

UrKinematics::UrKinematics(KinematicChain chain, UrArm arm)
    : chain_(std::move(chain)), arm_(std::move(arm)), X_0R_(inverse(arm_.X_R0)), X_T6_(inverse(arm_.X_6T)) {
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Eigen::Index index = chain_.joints[static_cast<std::size_t>(i)].index;
    index_[static_cast<std::size_t>(i)] = index;
    lower_[i] = chain_.lower[index];
    upper_[i] = chain_.upper[index];
  }
  middle_ = 0.5 * (lower_ + upper_);
  deviation_ = measure_deviation();
}

/// Frame 6 of the ideal arm, in frame 0, when the tip is at X_RT.
UrPose UrKinematics::frame6(const Isometry3d& X_RT) const {
  return X_0R_ * UrPose{X_RT.linear(), X_RT.translation()} * X_T6_;
}

double UrKinematics::measure_deviation() const {
  constexpr int kSamples = 64;
  Rng rng(1);
  double largest = 0.0;
  for (int sample = 0; sample < kSamples; ++sample) {
    Vector6d q;
    Vector6d theta;
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double angle = rng.uniform(-std::numbers::pi, std::numbers::pi);
      theta[i] = arm_.sign[i] * angle + arm_.zero[i];
      q[index_[static_cast<std::size_t>(i)]] = angle;
    }
    const UrPose ideal = ur_pose(arm_, theta);
    const UrPose printed = frame6(tip_pose(chain_, q));
    largest = std::max({largest, (ideal.R - printed.R).cwiseAbs().maxCoeff(), (ideal.p - printed.p).norm()});
  }
  return largest;
}

ArmBranches UrKinematics::branches(const Isometry3d& X_RT) const {
  require(X_RT.matrix().allFinite(), "the tip's pose is not finite");
  Search search{X_RT, X_0R_ * UrPose{orthonormal(X_RT.linear()), X_RT.translation()} * X_T6_, {}};
  const double free1 = arm_.sign[0] * middle_[0] + arm_.zero[0];
  for (const double side : {1.0, -1.0}) {
    const UrShoulder shoulder = ur_shoulder(arm_, search.X, side, free1);
    if (shoulder.miss > kSlack + 10.0 * deviation_) break;
    wrist_roots(search, shoulder, {side, 1.0, 1.0});
    wrist_roots(search, shoulder, {side, -1.0, 1.0});
  }
  return search.found;
}

void UrKinematics::wrist_roots(Search& search, const UrShoulder& shoulder, Sides sides) const {
  const UrWrist wrist = ur_wrist(arm_, search.X, shoulder, sides.wrist);
  if (wrist.sine >= kParallelWrist) {
    const bool any = elbow_roots(search, shoulder, wrist, sides);
    if (any || wrist.sine > kUncertain * deviation_) return;
  }
  // Axes 4 and 6 are parallel, or may be as far as an inexact arm tells.
  const auto with_joint6 = [&](double theta6) {
    const UrWrist chosen = ur_wrist_at(arm_, search.X, shoulder, sides.wrist, std::cos(theta6), std::sin(theta6));
    return elbow_roots(search, shoulder, chosen, sides);
  };
  const double free6 = arm_.sign[5] * middle_[5] + arm_.zero[5];
  if (with_joint6(free6)) return;
  for (const double side : {-1.0, 1.0}) {
    elbow_roots(search, shoulder, ur_wrist_extreme(arm_, search.X, shoulder, sides.wrist, side), sides);
  }
  if (deviation_ < kExact) return;
  for (int i = 1; i < 8; ++i) {
    if (with_joint6(free6 + i * kTurn / 8.0)) return;
  }
}

/// m: by how much the errors of the joints before it, large beside their singularities, move what the elbow must reach.
double UrKinematics::noise_of_elbow(const Search& search, const UrShoulder& shoulder, const UrWrist& wrist) const {
  const double noise = deviation_ + 1e-15;
  const double h = std::abs(shoulder.c1 * search.X.p.x() + shoulder.s1 * search.X.p.y());
  const double joint1 = std::min(std::sqrt(noise), noise / std::max(h, 1e-15));
  const double joint6 = (noise + joint1) / std::max(wrist.sine, kParallelWrist);
  return 10.0 * (std::abs(arm_.d4) * joint1 + std::abs(arm_.d5) * joint6);
}

/// Whether any was a solution; new ones are added to the search.
bool UrKinematics::elbow_roots(Search& search, const UrShoulder& shoulder, const UrWrist& wrist, Sides sides) const {
  const double free2 = arm_.sign[1] * middle_[1] + arm_.zero[1];
  const bool parallel = wrist.sine < kParallelWrist;
  bool any = false;
  for (const double side : {1.0, -1.0}) {
    const UrElbow elbow = ur_elbow(arm_, wrist, side, free2);
    if (elbow.miss > kSlack && elbow.miss > noise_of_elbow(search, shoulder, wrist)) break;
    sides.elbow = side;
    const double miss = std::max(shoulder.miss, elbow.miss);
    Vector6d theta = ur_angles(shoulder, wrist, elbow);
    // With a chosen joint 6 the stages cannot be run again for a corrected pose: they would choose another.
    const bool settled = deviation_ < kExact ? miss < kPoseTolerance : !parallel && correct(search, sides, theta, miss);
    any = accept(search, theta, settled) || any;
  }
  return any;
}

/// Defect correction of a solution of the ideal arm: solves U(theta') = U(theta) P(theta)^-1 X, where P is the printed
/// arm, until theta moves so little that the deviation, which varies by less than ten times itself per radian, is the
/// same. Whether it settled.
bool UrKinematics::correct(const Search& search, Sides sides, Vector6d& theta, double miss) const {
  UrPose ideal = miss == 0.0 ? search.X : ur_pose(arm_, theta);
  for (int pass = 0; pass < kCorrections; ++pass) {
    Vector6d q;
    for (Eigen::Index i = 0; i < 6; ++i) {
      q[index_[static_cast<std::size_t>(i)]] = arm_.sign[i] * (theta[i] - arm_.zero[i]);
    }
    const UrPose X = ideal * inverse(frame6(tip_pose(chain_, q))) * search.X;
    const UrShoulder shoulder = ur_shoulder(arm_, X, sides.shoulder, theta[0]);
    const UrWrist wrist = ur_wrist(arm_, X, shoulder, sides.wrist);
    if (wrist.sine < kParallelWrist) return false;
    const UrElbow elbow = ur_elbow(arm_, wrist, sides.elbow, theta[1]);
    miss = std::max(shoulder.miss, elbow.miss);
    const Vector6d next = ur_angles(shoulder, wrist, elbow);
    double moved = 0.0;
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double apart = std::abs(next[i] - theta[i]);
      moved = std::max(moved, std::min(apart, std::abs(apart - kTurn)));
    }
    theta = next;
    if (10.0 * deviation_ * moved < 0.1 * kPoseTolerance) return miss < 0.5 * kPoseTolerance;
    ideal = miss == 0.0 ? X : ur_pose(arm_, theta);
  }
  return false;
}

/// The arm position of theta, each joint in the turn nearest to the middle of its limits; order of the joints.
Vector6d UrKinematics::nearest_turn(const Vector6d& theta) const {
  Vector6d q = arm_.sign.cwiseProduct(theta - arm_.zero);
  for (Eigen::Index i = 0; i < 6; ++i) {
    while (q[i] - middle_[i] > 0.5 * kTurn) q[i] -= kTurn;
    while (q[i] - middle_[i] < -0.5 * kTurn) q[i] += kTurn;
  }
  return q;
}

/// Whether theta leads to a solution, be it a known one. settled: it meets the pose as it is.
bool UrKinematics::accept(Search& search, const Vector6d& theta, bool settled) const {
  const Vector6d angles = nearest_turn(theta);
  Vector6d q;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double outside = std::max(lower_[i] - angles[i], angles[i] - upper_[i]);
    if (!(outside < kOutside)) return false;  // NaN too
    settled = settled && outside < kClamped;
    q[index_[static_cast<std::size_t>(i)]] = std::clamp(angles[i], lower_[i], upper_[i]);
  }
  if (!settled) {
    const Descent descent = descend(chain_, {search.X_RT}, q, kIterations, kDescentGoal);
    if (!(descent.residual < kPoseTolerance)) return false;
    q = descent.q;
  }
  ArmBranches& found = search.found;
  if (std::any_of(found.begin(), found.end(), [&](const Vector6d& other) { return same(other, q); })) return true;
  if (found.count < 8) found.q[static_cast<std::size_t>(found.count++)] = q;
  return true;
}

std::vector<Eigen::VectorXd> UrKinematics::solve(const Isometry3d& X_RT) const {
  const ArmBranches found = branches(X_RT);
  std::vector<Eigen::VectorXd> solutions(found.begin(), found.end());
  add_turns(chain_, solutions);
  return solutions;
}

}  // namespace opponens::robot
