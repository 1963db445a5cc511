// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Bounds of one straight motion; made by MotionBound.
struct LinkTravel {
  /// [sum of chain lengths] m: per link, from its own joint up to the root, the sums of the joints' shares so far.
  std::vector<double> sums;
};

/// Upper bounds of how far the points of a robot's links travel while q moves on a straight line, for motion checks
/// that prove more than samples do (Schwarzer, Saha and Latombe 2005, doi:10.1109/TRO.2004.839232; Zhang, Redon, Lee
/// and Kim 2007, doi:10.1145/1276377.1276396).
///
/// Every point p of a link moves at |dp/ds| <= sum_j |dq_j/ds| r_j(p, s) over the joints j above it: r_j is its
/// distance from the axis of a revolute joint, and 1 for a prismatic one; mimicking joints count with their
/// multipliers, fixed and resting joints do not count. Instead of the sum of all link lengths, r_j over the whole
/// motion is bounded by the smaller of
///  - the distance in the middle of the motion + half of what the joints between j and the link can change it by,
///  - the chained distances of the axes between j and the link, which do not change,
/// so it approaches the distance itself as motions get short. A link is the smallest ball found around its collision
/// geometry (its origin when it has none). The bound is of arc length, so any part of the motion is bounded by its
/// share, and the distance of two links changes at most by their travel relative to each other. Up to rounding.
/// Immutable, thread-safe; the robot is not referred to after construction.
class MotionBound {
 public:
  /// factor: on every bound; below 1 they do not hold, which tests use to see that it is noticed.
  explicit MotionBound(const RobotModel& robot, double factor = 1.0);

  /// X_RL: link poses in the middle of the motion; step: [joints] rad or m, by which joint_positions changes from one
  /// end to the other. O(sum of chain lengths).
  LinkTravel travel(const std::vector<Eigen::Isometry3d>& X_RL, const Eigen::Ref<const Eigen::VectorXd>& step) const;
  /// The same, reusing the output's memory.
  void travel(const std::vector<Eigen::Isometry3d>& X_RL, const Eigen::Ref<const Eigen::VectorXd>& step,
              LinkTravel& result) const;

  /// m, of any point of the link, relative to the root.
  double of_link(const LinkTravel& travel, int link) const;
  /// Where the travel of two links relative to each other stands among the sums: that of each, -1 for none.
  struct Shares {
    int a;
    int b;
  };
  /// link_b < 0: a body that does not move with the robot.
  Shares shares(int link_a, int link_b) const;
  /// m, the same as between() or of_link(), of a part of the motion: share (0 to 1) of its length.
  double of_part(const LinkTravel& travel, const Shares& shares, double share) const {
    const double a = shares.a < 0 ? 0.0 : travel.sums[static_cast<std::size_t>(shares.a)];
    const double b = shares.b < 0 ? 0.0 : travel.sums[static_cast<std::size_t>(shares.b)];
    return factor_ * share * (a + b);
  }
  /// m, by which the distance of two links can change: only the joints below their last common ancestor count.
  double between(const LinkTravel& travel, int link_a, int link_b) const;

 private:
  struct MovingJoint {
    int joint;  ///< index in the description
    int link;   ///< its child, in which axis and origin are fixed
    bool revolute;
    Eigen::Vector3d axis;  ///< unit, in the child
  };
  struct Chain {
    std::size_t first;                ///< of its sums
    std::vector<MovingJoint> joints;  ///< from the link's own up to the root
    Eigen::Vector3d center;           ///< m, of the ball, in the link
    double radius;                    ///< m
  };
  double upper_part(const LinkTravel& travel, int link, std::size_t shared) const;

  std::vector<Chain> chains_;  ///< [links]
  Eigen::MatrixXi shared_;     ///< [links x links] moving joints above both
  std::size_t size_ = 0;
  double factor_;
};

/// [links] m, how far any point of each link is at most from where it was while q moves from q_a to q_b ([d] rad).
std::vector<double> link_displacements(const RobotModel& robot, const Eigen::Ref<const Eigen::VectorXd>& q_a,
                                       const Eigen::Ref<const Eigen::VectorXd>& q_b);

}  // namespace opponens::robot
