// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/free_joints.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace opponens::grasp {
namespace {

constexpr double kClosingShare = 0.5;  // share above which a joint counts as closing
constexpr double kFromTheEnd = 0.02;   // of a joint's range kept from its open end
constexpr double kOpenShare = 0.55;    // of a closing joint's range that postures start from
constexpr double kPreGrasp = 0.1;      // of every joint's range, half width of the open hand's box

}  // namespace

Eigen::VectorXd closing_joints(const robot::RobotModel& hand) {
  const Eigen::VectorXd middle = 0.5 * (hand.lower() + hand.upper());
  const std::vector<Eigen::Isometry3d> X_HL = hand.link_poses(middle);
  Eigen::VectorXd along = Eigen::VectorXd::Zero(hand.dof());
  Eigen::VectorXd all = Eigen::VectorXd::Zero(hand.dof());
  for (const robot::SurfacePoint& point : hand.description().contact_points) {
    const Eigen::Isometry3d& X = X_HL[static_cast<std::size_t>(point.link)];
    const Eigen::Matrix3Xd jacobian = hand.point_jacobian(X_HL, point.link, X * point.p_L);
    along += jacobian.transpose() * (X.linear() * point.n_L);
    all += jacobian.colwise().norm().transpose();
  }
  for (Eigen::Index j = 0; j < along.size(); ++j) along[j] = all[j] > 1e-9 ? along[j] / all[j] : 0.0;
  return along;
}

FreeJoints free_joints(const robot::RobotModel& hand) {
  const Eigen::VectorXd closing = closing_joints(hand);
  const Eigen::VectorXd range = hand.upper() - hand.lower();
  Eigen::VectorXd center = 0.5 * (hand.lower() + hand.upper());
  Eigen::VectorXd half_width = 0.5 * range;
  Eigen::VectorXd open = center;
  for (Eigen::Index j = 0; j < closing.size(); ++j) {
    if (std::abs(closing[j]) < kClosingShare) continue;
    const double end = closing[j] > 0.0 ? hand.lower()[j] : hand.upper()[j];
    const double inward = closing[j] > 0.0 ? range[j] : -range[j];
    half_width[j] = 0.5 * (kOpenShare - kFromTheEnd) * range[j];
    center[j] = end + 0.5 * (kOpenShare + kFromTheEnd) * inward;
    open[j] = end + (kPreGrasp + kFromTheEnd) * inward;
  }
  const auto box = [&](const Eigen::VectorXd& middle, const Eigen::VectorXd& half) {
    SynergyBox result;
    result.center = middle;
    result.axes = Eigen::MatrixXd::Identity(hand.dof(), hand.dof());
    result.half_width = half;
    result.scale = Eigen::VectorXd::Ones(hand.dof());
    return result;
  };
  FreeJoints free;
  free.group.name = "free joints";
  free.group.phase = "grasp";
  free.group.dof_effective = hand.dof();
  free.group.box = box(center, half_width);
  free.pre_grasp = box(open, kPreGrasp * range);
  return free;
}

}  // namespace opponens::grasp
