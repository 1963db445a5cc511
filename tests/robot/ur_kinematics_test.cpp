// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/ur_kinematics.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot_test.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

std::string our_robot() { return ours("ur5_allegro/ur5_allegro_right.yaml"); }

UrKinematics analytic(const RobotModel& robot) {
  auto arm = UrKinematics::of(kinematic_chain(robot, robot.arm(), robot.palm()));
  require(arm.has_value(), [&] { return arm.error().detail; });
  return std::move(*arm);
}

/// Poses by the whole robot's forward kinematics, not by the solver's.
class Palm {
 public:
  explicit Palm(const RobotModel& robot) : robot_(robot), q_(robot.clip(VectorXd::Zero(robot.dof()))) {}

  const Isometry3d& pose(const Vector6d& q_a) { return poses(q_a)[static_cast<std::size_t>(robot_.palm())]; }

  /// m, from the plane through axis 1 across the arm's plane to the point of axis 5 that is nearest to axis 6: zero at
  /// the shoulder singularity.
  double shoulder(const Vector6d& q_a) {
    poses(q_a);
    const auto [z1, p1] = axis(0);
    const auto [z2, p2] = axis(1);
    const auto [z5, p5] = axis(4);
    const auto [z6, p6] = axis(5);
    const Vector3d wrist = p5 + (p6 - p5).dot(z5) * z5;
    return (wrist - p1).dot(z1.cross(z2));
  }

 private:
  const std::vector<Isometry3d>& poses(const Vector6d& q_a) {
    q_.head<6>() = q_a;
    robot_.link_poses(q_, X_RL_);
    return X_RL_;
  }
  std::pair<Vector3d, Vector3d> axis(std::size_t arm_joint) const {
    for (const Joint& joint : robot_.description().joints) {
      if (joint.name != robot_.arm().joint_names[arm_joint]) continue;
      const Isometry3d& X = X_RL_[static_cast<std::size_t>(joint.child)];
      return {X.linear() * joint.axis, X.translation()};
    }
    throw std::invalid_argument("no such joint");
  }

  const RobotModel& robot_;
  VectorXd q_;
  std::vector<Isometry3d> X_RL_;
};

struct Sample {
  Vector6d q;
  bool shoulder = false, elbow = false, wrist = false;  ///< within 1e-3 of its singularity
  double near = 0.0;                                    ///< rad or m from it
  int singularities() const { return shoulder + elbow + wrist; }
  bool joint6_free() const { return wrist && near < (shoulder ? 1e-4 : 1e-8); }
};

/// How near to singularities samples come.
struct Nearness {
  double least = 0.0;
  bool several = true;  ///< two or three at once too
};

/// Half of the samples anywhere; the others within 0 or 1e-12 to 1e-3 of one, two or all three singularities.
Sample draw(const RobotModel& robot, Palm& palm, const Nearness& nearness, Rng& rng) {
  Sample sample;
  for (int i = 0; i < 6; ++i) sample.q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
  const std::uint64_t kind = rng.index(14) + 1;
  if (kind > 7 || (!nearness.several && (kind & (kind - 1)) != 0)) return sample;
  sample.shoulder = (kind & 1) != 0;
  sample.elbow = (kind & 2) != 0;
  sample.wrist = (kind & 4) != 0;
  sample.near = rng.uniform() < 0.1 ? 0.0 : std::pow(10.0, -rng.uniform(3, 12));
  sample.near = std::max(sample.near, nearness.least);
  const double side = rng.uniform() < 0.5 ? -1.0 : 1.0;
  if (sample.elbow) sample.q[2] = side * (rng.uniform() < 0.5 ? sample.near : kPi - sample.near);
  if (sample.wrist) sample.q[4] = side * (rng.uniform() < 0.5 ? sample.near : kPi - sample.near);
  if (sample.shoulder) {  // A cos q2 + B sin q2 = near
    sample.q[1] = 0.0;
    const double A = palm.shoulder(sample.q);
    sample.q[1] = kPi / 2;
    const double B = palm.shoulder(sample.q);
    sample.q[1] = std::atan2(B, A) + side * std::acos(std::min(1.0, sample.near / std::hypot(A, B)));
  }
  return sample;
}

double turns_apart(const Vector6d& a, const Vector6d& b, std::initializer_list<int> joints) {
  double largest = 0.0;
  for (const int i : joints) largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * kPi)));
  return largest;
}

/// How far the position itself is from coming back; at a wrist singularity joint 6 is free, and 1 and 5 are compared.
double missing(const Sample& sample, const ArmBranches& found) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector6d& q : found) {
    const double apart =
        sample.joint6_free() ? turns_apart(q, sample.q, {0, 4}) : turns_apart(q, sample.q, {0, 1, 2, 3, 4, 5});
    nearest = std::min(nearest, apart);
  }
  return nearest;
}

/// How far it may be. Joint 1 comes first: it moves by the pose's error (by the tolerance where a solution needed
/// damped least squares: inexact axes, two singularities) over the shoulder's distance from singular, at most by the
/// error's square root. Joint 6 moves by that over the sine of joint 5, the elbow as the shoulder. Roots 1e-6 apart
/// count as one. On an arm with inexact axes another joint 6 means other errors.
double allowed(const Sample& sample, double shoulder, double deviation) {
  const auto root = [](double error, double distance) {
    return std::min(3.0 * std::sqrt(error), 10.0 * error / std::abs(distance));
  };
  double error = deviation < 1e-12 && sample.singularities() < 2 ? 1e-14 : 1e-11;
  if (sample.joint6_free()) error += 10.0 * deviation;
  error = root(error, shoulder);
  if (!sample.joint6_free()) error = root(error / std::abs(std::sin(sample.q[4])), std::sin(sample.q[2]));
  return error + 2e-6;
}

void check_round_trips(const RobotModel& robot, int samples, const Nearness& nearness = {}) {
  const UrKinematics arm = analytic(robot);
  Palm palm(robot);
  Rng rng(11);
  double largest_residual = 0.0;
  double largest_missing = 0.0;
  double largest_plain = 0.0;
  for (int i = 0; i < samples; ++i) {
    const Sample sample = draw(robot, palm, nearness, rng);
    const Isometry3d X_RH = palm.pose(sample.q);
    SCOPED_TRACE(testing::Message() << "sample " << i << " near " << sample.near << " shoulder " << sample.shoulder
                                    << " elbow " << sample.elbow << " wrist " << sample.wrist << " q "
                                    << sample.q.transpose());
    const ArmBranches found = arm.branches(X_RH);
    for (const Vector6d& q : found) {
      ASSERT_TRUE(q.allFinite());
      ASSERT_TRUE(((q - robot.lower().head<6>()).array() >= 0.0).all() &&
                  ((robot.upper().head<6>() - q).array() >= 0.0).all());
      largest_residual = std::max(largest_residual, (palm.pose(q).matrix() - X_RH.matrix()).cwiseAbs().maxCoeff());
    }
    ASSERT_LT(largest_residual, 1e-10);
    for (int a = 0; a < found.count; ++a) {
      for (int b = 0; b < a; ++b) {
        ASSERT_GT(turns_apart(found.begin()[a], found.begin()[b], {0, 1, 2, 3, 4, 5}), 1e-6);
      }
    }
    const double lost = missing(sample, found);
    ASSERT_LT(lost, allowed(sample, palm.shoulder(sample.q), arm.deviation()));
    const bool plain = !sample.shoulder && !sample.elbow && !sample.wrist;
    (plain ? largest_plain : largest_missing) = std::max(plain ? largest_plain : largest_missing, lost);
    if (i % 50 != 0) continue;
    // With all turns the position comes back as it is, not only up to turns.
    double nearest = std::numeric_limits<double>::infinity();
    for (const VectorXd& q : arm.solve(X_RH)) {
      ASSERT_TRUE(((q - robot.lower().head<6>()).array() >= 0.0).all() &&
                  ((robot.upper().head<6>() - q).array() >= 0.0).all());
      ASSERT_LT((palm.pose(q).matrix() - X_RH.matrix()).cwiseAbs().maxCoeff(), 1e-10);
      nearest = std::min(nearest, (q - sample.q).cwiseAbs().maxCoeff());
    }
    if (plain) {
      ASSERT_LT(nearest, 1e-7);
    }
  }
  EXPECT_LT(largest_plain, 1e-7);
  std::printf(
      "%s: %d poses; deviation of the ideal arm %.1e; largest residual %.1e; position missed by at most %.1e,"
      " beside singularities %.1e\n",
      robot.description().name.c_str(), samples, arm.deviation(), largest_residual, largest_plain, largest_missing);
}

constexpr int kSamples = sample_count(100000);

TEST(UrKinematics, RoundTripsOnOurRobot) { check_round_trips(RobotModel(load_robot(our_robot())), kSamples); }

class OnRealRobots : public testing::TestWithParam<const char*> {};

TEST_P(OnRealRobots, RoundTrips) {
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  const std::string file = OPPONENS_SOURCE_DIR "/tests/data/robots/" + std::string(GetParam()) + ".yaml";
  check_round_trips(RobotModel(load_robot(file)), kSamples);
}
INSTANTIATE_TEST_SUITE_P(UrKinematics, OnRealRobots,
                         testing::Values("example_ur5_allegro_right", "paper_lab_ur5_allegro_right_urdf"));

TEST(UrKinematics, GivesAllEightBranchesAndEveryTurn) {
  const RobotModel robot(load_robot(our_robot()));
  const UrKinematics arm = analytic(robot);
  Vector6d q;
  q << 0.3, -1.2, 1.4, -0.9, 0.8, 0.5;
  const Isometry3d X_RH = Palm(robot).pose(q);
  EXPECT_EQ(arm.branches(X_RH).count, 8);
  // Five joints of two turns each, the elbow has one.
  EXPECT_EQ(arm.solve(X_RH).size(), 8u * 32u);
}

TEST(UrKinematics, HoldsItsChoiceAtTheWristSingularity) {
  const RobotModel robot(load_robot(our_robot()));
  Vector6d q;
  q << 0.3, -1.2, 1.4, -0.9, 0.0, 0.7;
  int straight = 0;
  for (const Vector6d& branch : analytic(robot).branches(Palm(robot).pose(q))) {
    if (std::abs(std::remainder(branch[4], kPi)) > 1e-9) continue;  // the other shoulder has a bent wrist
    ++straight;
    EXPECT_NEAR(branch[5], 0.0, 1e-9);
  }
  EXPECT_EQ(straight, 2);
}

/// Joint 6 at its middle would ask the elbow for more than its length.
TEST(UrKinematics, FindsTheFreeJointThatTheElbowNeeds) {
  const RobotModel robot(load_robot(our_robot()));
  const UrKinematics arm = analytic(robot);
  Palm palm(robot);
  Vector6d q;
  q << 0.3, -0.4, 0.0, -kPi / 2, 0.0, 2.0;  // stretched, axis 6 beyond axis 4
  const ArmBranches found = arm.branches(palm.pose(q));
  ASSERT_GT(found.count, 0);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector6d& other : found) nearest = std::min(nearest, turns_apart(other, q, {0, 1, 2, 3, 4, 5}));
  EXPECT_LT(nearest, 1e-6);
}

TEST(UrKinematics, NothingBeyondReachAndNothingFromNan) {
  const UrKinematics arm = analytic(RobotModel(load_robot(our_robot())));
  Isometry3d X_RH = Isometry3d::Identity();
  X_RH.translation() << 2.0, 0, 0;
  EXPECT_TRUE(arm.solve(X_RH).empty());
  X_RH.translation() << 0, 0, 0.1;  // the wrist inside the shoulder's cylinder
  for (const VectorXd& q : arm.solve(X_RH)) EXPECT_TRUE(q.allFinite());
  X_RH.translation().x() = std::nan("");
  EXPECT_THROW(arm.solve(X_RH), std::invalid_argument);
  X_RH.translation().x() = 0.3;
  X_RH.linear() *= 1.1;
  EXPECT_THROW(arm.solve(X_RH), std::invalid_argument);
}

/// The ideal arm is the model: its forward kinematics agree with the tree's, for every sign and zero of the joints.
TEST(UrKinematics, TheIdealArmIsTheModel) {
  const RobotModel robot(load_robot(our_robot()));
  const UrKinematics arm = analytic(robot);
  EXPECT_NEAR(arm.ideal().a2, 0.425, 1e-15);
  EXPECT_NEAR(arm.ideal().a3, 0.39225, 1e-15);
  EXPECT_NEAR(std::abs(arm.ideal().d4), 0.10915, 1e-15);
  EXPECT_NEAR(std::abs(arm.ideal().d5), 0.09465, 1e-15);
  EXPECT_LT(arm.deviation(), 1e-14);
}

TEST(UrKinematics, TakesJointsThatTurnTheOtherWay) {
  RobotDescription description = load_robot(our_robot());
  for (Joint& joint : description.joints) {
    if (joint.type == JointType::revolute && joint.name.find("joint") != std::string::npos) joint.axis *= -1.0;
  }
  check_round_trips(RobotModel(description), 2000);
}

/// Axes off by 1e-9, as angles printed with nine digits leave them: far from 1e-10, which defect correction gives.
/// Nearer to a singularity than some ten deviations, or where several meet, the arm's errors decide what is reached,
/// and a branch may be lost.
TEST(UrKinematics, RoundTripsOnAnArmPrintedWithFewDigits) {
  RobotDescription description = load_robot(our_robot());
  Rng rng(4);
  for (Joint& joint : description.joints) {
    if (joint.name.find("_joint") == std::string::npos) continue;
    const Vector3d axis(rng.normal(), rng.normal(), rng.normal());
    joint.X_PJ.rotate(Eigen::AngleAxisd(1e-9, axis.normalized()));
  }
  const RobotModel robot(description);
  EXPECT_GT(analytic(robot).deviation(), 1e-9);
  check_round_trips(robot, sample_count(20000), {1e-7, false});
}

TEST(UrKinematics, RefusesOtherArms) {
  const RobotDescription description = load_robot(our_robot());
  const auto message = [](const RobotDescription& changed) {
    const RobotModel robot(changed);
    const auto arm = UrKinematics::of(kinematic_chain(robot, robot.arm(), robot.palm()));
    return arm ? std::string("accepted") : arm.error().detail;
  };
  EXPECT_EQ(message(description), "accepted");
  const auto changed = [&](const std::string& name, auto change) {
    RobotDescription other = description;
    for (Joint& joint : other.joints) {
      if (joint.name == name) change(joint);
    }
    return message(other);
  };
  const auto tilt = [](Joint& joint) { joint.X_PJ.rotate(Eigen::AngleAxisd(0.1, Vector3d::UnitX())); };
  const auto shift = [](Joint& joint) { joint.X_PJ.translation().x() += 0.01; };
  EXPECT_NE(changed("elbow_joint", tilt).find("2, 3 and 4 are not parallel"), std::string::npos);
  EXPECT_NE(changed("shoulder_lift_joint", tilt).find("1 and 2 are not perpendicular"), std::string::npos);
  EXPECT_NE(changed("wrist_2_joint", tilt).find("4 and 5 are not perpendicular"), std::string::npos);
  EXPECT_NE(changed("wrist_3_joint", tilt).find("5 and 6 are not perpendicular"), std::string::npos);
  EXPECT_NE(changed("shoulder_lift_joint", shift).find("1 and 2 do not meet"), std::string::npos);
  EXPECT_NE(changed("wrist_2_joint", shift).find("4 and 5 do not meet"), std::string::npos);
  EXPECT_NE(changed("wrist_3_joint", shift).find("5 and 6 do not meet"), std::string::npos);
  const auto slide = [](Joint& joint) { joint.type = JointType::prismatic; };
  EXPECT_NE(changed("elbow_joint", slide).find("joint 3 is prismatic"), std::string::npos);
  RobotDescription shorter = description;
  shorter.arm_joints.pop_back();
  shorter.weights.resize(0);
  EXPECT_NE(message(shorter).find("6 joints"), std::string::npos) << message(shorter);
}

}  // namespace
}  // namespace opponens::robot
