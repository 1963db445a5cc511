// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/kinematic_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"

namespace opponens::robot {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kOnLimit = 2e-11;  ///< rad: a copy that much outside is on the limit

Isometry3d joint_motion(JointType type, const Vector3d& axis, double position) {
  Isometry3d X = Isometry3d::Identity();
  if (type == JointType::revolute) X.linear() = Eigen::AngleAxisd(position, axis).toRotationMatrix();
  if (type == JointType::prismatic) X.translation() = position * axis;
  return X;
}

/// Joints of the description from the root to a link.
std::vector<std::size_t> way_to(const RobotModel& robot, int link) {
  std::vector<std::size_t> way;
  for (int i = robot.links()[static_cast<std::size_t>(link)].joint; i >= 0;) {
    way.push_back(static_cast<std::size_t>(i));
    i = robot.links()[static_cast<std::size_t>(robot.description().joints[way.back()].parent)].joint;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

/// Rotation and origin of a pose that grows joint by joint; Isometry3d's fourth row costs time.
struct Frame {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d p = Vector3d::Zero();

  void step(const Isometry3d& X) {
    p += R * X.translation();
    R = (R * X.linear()).eval();
  }
  void move(const KinematicChain::Joint& joint, double position) {
    if (!joint.revolute) {
      p += position * R.col(2);
      return;
    }
    const double c = std::cos(position);
    const double s = std::sin(position);
    const Vector3d x = c * R.col(0) + s * R.col(1);
    R.col(1) = c * R.col(1) - s * R.col(0);
    R.col(0) = x;
  }
  Isometry3d pose() const {
    Isometry3d X;
    X.linear() = R;
    X.translation() = p;
    X.makeAffine();
    return X;
  }
};

}  // namespace

Eigen::Array<bool, Eigen::Dynamic, 1> KinematicChain::moving() const {
  Eigen::Array<bool, Eigen::Dynamic, 1> result = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(lower.size(), false);
  for (const Joint& joint : joints) result[joint.index] = true;
  return result;
}

Eigen::Array<bool, Eigen::Dynamic, 1> KinematicChain::turns() const {
  Eigen::Array<bool, Eigen::Dynamic, 1> result = moving();
  for (const Joint& joint : joints) {
    if (!joint.revolute || joint.multiplier != std::round(joint.multiplier)) result[joint.index] = false;
  }
  return result;
}

KinematicChain kinematic_chain(const RobotModel& robot, const PlanningGroup& group, int tip,
                               const Eigen::VectorXd& rest) {
  require(rest.size() == 0 || rest.size() == robot.dof(), "kinematic_chain: rest has " + std::to_string(rest.size()) +
                                                              " joints, the robot " + std::to_string(robot.dof()));
  require(tip >= 0 && static_cast<std::size_t>(tip) < robot.links().size(), "kinematic_chain: no such link");
  require(group.first >= 0 && group.first + group.count <= robot.dof(), "kinematic_chain: no group of this robot");
  const Eigen::VectorXd q = robot.clip(rest.size() > 0 ? rest : Eigen::VectorXd::Zero(robot.dof()));
  KinematicChain chain;
  chain.lower = robot.lower().segment(group.first, group.count);
  chain.upper = robot.upper().segment(group.first, group.count);
  chain.rest = q.segment(group.first, group.count);
  Isometry3d X = Isometry3d::Identity();  // since the last moving joint
  for (const std::size_t i : way_to(robot, tip)) {
    const Joint& joint = robot.description().joints[i];
    const RobotModel::Drive& drive = robot.drives()[i];
    const int index = drive.index - group.first;
    X = X * joint.X_PJ;
    if (joint.type == JointType::fixed) continue;
    if (drive.index < 0 || index < 0 || index >= group.count || drive.multiplier == 0.0) {
      const double position = (drive.index < 0 ? 0.0 : drive.multiplier * q[drive.index]) + drive.offset;
      X = X * joint_motion(joint.type, joint.axis, position);
      continue;
    }
    const Eigen::Quaterniond to_axis = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), joint.axis);
    chain.joints.push_back({X * to_axis, joint.type == JointType::revolute, index, drive.multiplier, drive.offset});
    X = Isometry3d(to_axis.inverse());
  }
  require(!chain.joints.empty(), [&] {
    return "no joint of group '" + group.name + "' moves link '" + robot.links()[static_cast<std::size_t>(tip)].name +
           "'";
  });
  chain.X_JT = X;
  return chain;
}

Isometry3d tip_pose(const KinematicChain& chain, const Eigen::Ref<const Eigen::VectorXd>& q) {
  Frame frame;
  for (const KinematicChain::Joint& joint : chain.joints) {
    frame.step(joint.X_PJ);
    frame.move(joint, joint.multiplier * q[joint.index] + joint.offset);
  }
  frame.step(chain.X_JT);
  return frame.pose();
}

Isometry3d tip_pose(const KinematicChain& chain, const Eigen::Ref<const Eigen::VectorXd>& q,
                    Eigen::Matrix<double, 6, Eigen::Dynamic>& jacobian) {
  const Isometry3d X_RT = tip_pose(chain, q);
  jacobian.setZero(6, chain.lower.size());
  Frame frame;
  for (const KinematicChain::Joint& joint : chain.joints) {
    frame.step(joint.X_PJ);
    const Vector3d axis = joint.multiplier * frame.R.col(2);
    if (joint.revolute) {
      jacobian.col(joint.index).head<3>() += axis;
      jacobian.col(joint.index).tail<3>() += axis.cross(X_RT.translation() - frame.p);
    } else {
      jacobian.col(joint.index).tail<3>() += axis;
    }
    frame.move(joint, joint.multiplier * q[joint.index] + joint.offset);
  }
  return X_RT;
}

Eigen::Matrix<double, 6, 1> pose_error(const Isometry3d& X_RA, const Isometry3d& X_RB) {
  const Eigen::Quaterniond turn(Eigen::Matrix3d(X_RB.linear() * X_RA.linear().transpose()));
  const Eigen::AngleAxisd angle_axis(turn.normalized());
  Eigen::Matrix<double, 6, 1> error;
  error << angle_axis.angle() * angle_axis.axis(), X_RB.translation() - X_RA.translation();
  return error;
}

void add_turns(const KinematicChain& chain, std::vector<Eigen::VectorXd>& solutions) {
  const auto turns = chain.turns();
  for (Eigen::Index joint = 0; joint < turns.size(); ++joint) {
    if (!turns[joint]) continue;
    const std::size_t count = solutions.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double q = solutions[i][joint];
      const int first = static_cast<int>(std::ceil((chain.lower[joint] - q - kOnLimit) / kTurn));
      const int last = static_cast<int>(std::floor((chain.upper[joint] - q + kOnLimit) / kTurn));
      for (int turn = first; turn <= last; ++turn) {
        if (turn == 0) continue;
        Eigen::VectorXd copy = solutions[i];
        copy[joint] = std::clamp(q + turn * kTurn, chain.lower[joint], chain.upper[joint]);
        solutions.push_back(std::move(copy));
      }
    }
  }
}

}  // namespace opponens::robot
