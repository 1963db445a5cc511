// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/pose_chart.hpp"

#include <cmath>

namespace opponens::grasp {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace

Eigen::Matrix3d turning_jacobian(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d s = cross_matrix(w);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() + 0.5 * s;
  const double a2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / a2 * s +
         (angle - std::sin(angle)) / (a2 * angle) * s * s;
}

Eigen::Isometry3d chart_pose(const Eigen::Isometry3d& X, const Eigen::Ref<const Eigen::VectorXd>& z) {
  const Eigen::Vector3d w = z.segment<3>(3);
  const double angle = w.norm();
  const Eigen::Matrix3d turn = angle < 1e-12 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity() + cross_matrix(w))
                                             : Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
  Eigen::Isometry3d result = X;
  result.linear() = turn * X.linear();
  result.translation() += kChartPosition * z.head<3>();
  return result;
}

PointSlopes::PointSlopes(const robot::RobotModel& hand, const HandSurface& surface) : hand_(hand), surface_(surface) {
  const robot::RobotDescription& d = hand.description();
  chain_.resize(d.links.size());
  for (std::size_t link = 0; link < d.links.size(); ++link) {  // topological order: the parent's chain is there
    if (d.links[link].joint < 0) continue;
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[link].joint)];
    chain_[link] = chain_[static_cast<std::size_t>(joint.parent)];
    if (surface.drives[link].index >= 0) chain_[link].push_back(link);
  }
}

void PointSlopes::place(const Eigen::Isometry3d& X_OH, const Eigen::Vector3d& w,
                        const std::vector<Eigen::Isometry3d>& X_HL) {
  X_OH_ = X_OH;
  left_jacobian_ = turning_jacobian(w);
  X_HL_ = &X_HL;
}

void PointSlopes::add(std::size_t link, const Eigen::Vector3d& p_O, const Eigen::Vector3d& g_O,
                      Eigen::Ref<Eigen::VectorXd> slope) const {
  const Eigen::Vector3d arm = p_O - X_OH_.translation();
  slope.head<3>() += kChartPosition * g_O;
  slope.segment<3>(3) += left_jacobian_.transpose() * arm.cross(g_O);
  const Eigen::Vector3d p_H = X_OH_.linear().transpose() * arm;
  const Eigen::Vector3d g_H = X_OH_.linear().transpose() * g_O;
  const robot::RobotDescription& d = hand_.description();
  for (const std::size_t moved : chain_[link]) {
    const robot::Joint& joint = d.joints[static_cast<std::size_t>(d.links[moved].joint)];
    const Eigen::Isometry3d& X_HJ = (*X_HL_)[moved];
    const Eigen::Vector3d axis = X_HJ.linear() * joint.axis;
    const double along =
        joint.type == robot::JointType::prismatic ? axis.dot(g_H) : axis.dot((p_H - X_HJ.translation()).cross(g_H));
    const LinkDrive& drive = surface_.drives[moved];
    slope[6 + drive.index] += drive.multiplier * along;
  }
}

}  // namespace opponens::grasp
