// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "report/body_drawing.hpp"
#include "robot/robot_model.hpp"

namespace opponens::report {

/// Directions of a hand in its root frame, all unit.
struct HandAxes {
  Eigen::Vector3d fingers;  ///< from the palm to the fingertips, at rest
  Eigen::Vector3d palm;     ///< out of the palm
  Eigen::Vector3d thumb;    ///< sideways, to the thumb
};
HandAxes hand_axes(const robot::RobotModel& hand);

/// A hand posture with the words under it.
struct Posture {
  Eigen::VectorXd q;  ///< [n] rad, the hand model's joint order
  std::string caption;
};

/// Postures of a hand side by side, at one scale, seen obliquely from the palm and the thumb's side, fingers up.
std::string draw_postures(const robot::RobotModel& hand, const RobotFacets& facets,
                          const std::vector<Posture>& postures, const std::string& title, double cell_width,
                          double height);

}  // namespace opponens::report
