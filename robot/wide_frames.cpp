// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The moving frames of a robot.
#include <algorithm>
#include <cmath>

#include "robot/wide_world.hpp"

namespace opponens::robot::wide {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSlideSlack = 0.01;  ///< m, of sliding joints beyond their limits

/// A rotation that turns the z axis into the given one: orthonormal to rounding for every axis, as the quaternion from
/// two vectors is not when they are nearly opposite (by 5e-5 for an axis 1e-6 off -z).
Eigen::Matrix3d z_onto(const Vector3d& axis) {
  Eigen::Matrix3d R;
  R.col(2) = axis.normalized();
  R.col(0) = R.col(2).unitOrthogonal();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

Isometry3d turned(const Eigen::Matrix3d& R) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = R;
  return X;
}

}  // namespace

/// Links joined by joints that do not move share a frame. A joint's frame has its axis as z.
void World::add_frames(const RobotModel& robot) {
  const Frame still{kWorld, Motion::none, -1, 1.0, 0.0, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
  frames_ = {still, still};
  spread_frames_ = {{}, {}};  // of which the sweep takes none
  reach_ = {{Vector3d::Zero(), 0.0}, {Vector3d::Zero(), 0.0}};
  depth_ = {0, 0};
  frame_of_link_ = {kRoot};
  X_FL_ = {Isometry3d::Identity()};
  const std::vector<Joint>& joints = robot.description().joints;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot.dof());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const RobotModel::Drive& drive = robot.drives()[i];
    const auto parent_link = static_cast<std::size_t>(joint.parent);
    const int parent = frame_of_link_[parent_link];
    if (joint.type == JointType::fixed || drive.index < 0) {
      Isometry3d X_FC;
      robot.place_child(i, zero, X_FL_[parent_link], X_FC);
      frame_of_link_.push_back(parent);
      X_FL_.push_back(X_FC);
      continue;
    }
    const Eigen::Matrix3d Q = z_onto(joint.axis);
    const Isometry3d X_PF = X_FL_[parent_link] * joint.X_PJ * turned(Q);
    Frame frame = still;
    frame.parent = parent;
    frame.motion = joint.type == JointType::revolute ? Motion::turn : Motion::slide;
    frame.joint = drive.index;
    frame.multiplier = drive.multiplier;
    frame.offset = drive.offset;
    store_rotation(X_PF.linear(), frame.rotation);
    store(X_PF.translation(), frame.translation);
    add_spread_frame(X_PF);
    const Reach before = reach_[static_cast<std::size_t>(parent)];
    Reach reach = parent == kRoot ? Reach{X_PF.translation(), 0.0}
                                  : Reach{before.center, before.radius + X_PF.translation().norm()};
    if (frame.motion == Motion::slide) {
      const Slide slide{frame.joint, robot.lower()[frame.joint] - kSlideSlack,
                        robot.upper()[frame.joint] + kSlideSlack};
      slides_.push_back(slide);
      reach.radius += std::max(std::abs(frame.multiplier * slide.lower + frame.offset),
                               std::abs(frame.multiplier * slide.upper + frame.offset));
    }
    reach_.push_back(reach);
    depth_.push_back(depth_[static_cast<std::size_t>(parent)] + 1);
    frame_of_link_.push_back(static_cast<int>(frames_.size()));
    X_FL_.push_back(turned(Q.transpose()));
    frames_.push_back(frame);
  }
}

void World::add_spread_frame(const Isometry3d& X_PF) {
  SpreadFrame frame;
  for (int k = 0; k < 3; ++k) {
    for (int column = 0; column < 3; ++column) std::fill_n(frame.column[column][k], 4, X_PF.linear()(k, column));
    std::fill_n(frame.translation[k], 4, X_PF.translation()[k]);
  }
  spread_frames_.push_back(frame);
}

}  // namespace opponens::robot::wide
