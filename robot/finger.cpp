// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/finger.hpp"

#include <algorithm>

namespace opponens::robot {

namespace {

const Eigen::Isometry3d& at(const std::vector<Eigen::Isometry3d>& X, int link) {
  return X[static_cast<std::size_t>(link)];
}

/// Moving joints between palm and link, palm first.
std::vector<int> moving_chain(const RobotModel& hand, int link) {
  std::vector<int> chain;
  while (link != hand.palm() && hand.links()[static_cast<std::size_t>(link)].joint >= 0) {
    const int joint = hand.links()[static_cast<std::size_t>(link)].joint;
    const Joint& description = hand.description().joints[static_cast<std::size_t>(joint)];
    if (description.type != JointType::fixed) chain.insert(chain.begin(), joint);
    link = description.parent;
  }
  return chain;
}

/// Origins of the chain's joints and then the tip, in the palm frame [3 x joints + 1].
Eigen::Matrix3Xd chain_points(const RobotModel& hand, const std::vector<int>& chain, const Finger& finger,
                              const Eigen::VectorXd& q) {
  const std::vector<Eigen::Isometry3d> X_RL = hand.link_poses(q);
  const Eigen::Isometry3d X_PR = at(X_RL, hand.palm()).inverse();
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(chain.size()) + 1);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const int child = hand.description().joints[static_cast<std::size_t>(chain[i])].child;
    points.col(static_cast<Eigen::Index>(i)) = X_PR * at(X_RL, child).translation();
  }
  points.rightCols<1>() = X_PR * (at(X_RL, finger.link) * finger.p_L);
  return points;
}

std::vector<int> joints_moving(const RobotModel& hand, int link) {
  const Eigen::VectorXd q = 0.5 * (hand.lower() + hand.upper());
  const std::vector<Eigen::Isometry3d> X = hand.link_poses(q);
  const Eigen::Isometry3d X_LP = at(X, link).inverse() * at(X, hand.palm());
  std::vector<int> moving;
  for (int i = hand.hand().first; i < hand.dof(); ++i) {
    Eigen::VectorXd moved = q;
    moved[i] += 0.1;
    const std::vector<Eigen::Isometry3d> Y = hand.link_poses(moved);
    const Eigen::Isometry3d change = X_LP * at(Y, hand.palm()).inverse() * at(Y, link);
    if (!change.isApprox(Eigen::Isometry3d::Identity(), 1e-9)) moving.push_back(i);
  }
  return moving;
}

}  // namespace

Finger finger_of(const RobotModel& hand, const SurfacePoint& tip) {
  Finger finger{tip.link, tip.p_L, Eigen::Vector3d::Zero(), 0.0, joints_moving(hand, tip.link)};
  const std::vector<int> chain = moving_chain(hand, tip.link);
  const Eigen::VectorXd middle = 0.5 * (hand.lower() + hand.upper());
  const Eigen::Matrix3Xd points = chain_points(hand, chain, finger, middle);
  Eigen::VectorXd wander = Eigen::VectorXd::Zero(points.cols());
  for (const int joint : finger.moved_by) {
    for (const double end : {hand.lower()[joint], hand.upper()[joint]}) {
      Eigen::VectorXd q = middle;
      q[joint] = end;
      const Eigen::Matrix3Xd moved = chain_points(hand, chain, finger, q);
      wander = wander.cwiseMax((moved - points).colwise().norm().transpose());
    }
  }
  Eigen::Index base = 0;
  while (base + 2 < points.cols() && wander[base + 1] < 1e-6) ++base;
  finger.base = points.col(base);
  for (Eigen::Index i = base; i + 1 < points.cols(); ++i) finger.length += (points.col(i + 1) - points.col(i)).norm();
  return finger;
}

Eigen::Matrix3Xd tip_path(const RobotModel& hand, const Finger& finger, const Eigen::MatrixXd& q) {
  Eigen::Matrix3Xd path(3, q.cols());
  std::vector<Eigen::Isometry3d> X_RL;
  for (Eigen::Index t = 0; t < q.cols(); ++t) {
    hand.link_poses(q.col(t), X_RL);
    path.col(t) = at(X_RL, hand.palm()).inverse() * (at(X_RL, finger.link) * finger.p_L);
  }
  return path;
}

}  // namespace opponens::robot
