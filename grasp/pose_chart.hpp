// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "grasp/hand_surface.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// Metres per unit of a chart's first three coordinates: brings positions to the size of angles.
constexpr double kChartPosition = 0.1;

/// Pose at chart coordinates z = [t / kChartPosition; w] around X: the position moves by t, the rotation is turned from
/// the left by exp([w]x).
Eigen::Isometry3d chart_pose(const Eigen::Isometry3d& X, const Eigen::Ref<const Eigen::VectorXd>& z);

/// How the rotation of chart_pose turns with w: d exp([w]x) = [J dw]x exp([w]x), the left Jacobian of SO(3) (Chirikjian
/// 2012, section 10.8.6).
Eigen::Matrix3d turning_jacobian(const Eigen::Vector3d& w);

/// The slope by [z; q] of a scalar that depends on points fixed to links of a free hand, summed point by point.
class PointSlopes {
 public:
  PointSlopes(const robot::RobotModel& hand, const HandSurface& surface);

  /// The hand stands at chart coordinates z around some pose: X_OH = chart_pose(.., z), links at X_HL.
  void place(const Eigen::Isometry3d& X_OH, const Eigen::Vector3d& w, const std::vector<Eigen::Isometry3d>& X_HL);

  /// Adds d s / d [z; q] to slope [6 + n]: s changes by g_O'dp where the point p_O of the link moves by dp (m, in O).
  void add(std::size_t link, const Eigen::Vector3d& p_O, const Eigen::Vector3d& g_O,
           Eigen::Ref<Eigen::VectorXd> slope) const;

 private:
  const robot::RobotModel& hand_;
  const HandSurface& surface_;
  std::vector<std::vector<std::size_t>> chain_;  ///< per link: itself and its ancestors that a joint of q moves
  Eigen::Isometry3d X_OH_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d left_jacobian_ = Eigen::Matrix3d::Identity();
  const std::vector<Eigen::Isometry3d>* X_HL_ = nullptr;
};

}  // namespace opponens::grasp
