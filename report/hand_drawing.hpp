// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "report/body_drawing.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::report {

/// A hand posture with the words under it.
struct Posture {
  Eigen::VectorXd q;  ///< [n] rad, the hand model's joint order
  std::string caption;
};

/// Postures of a hand side by side, at one scale, seen obliquely from the palm and the thumb's side, fingers up.
std::string draw_postures(const robot::RobotModel& hand, const RobotFacets& facets,
                          const std::vector<Posture>& postures, const std::string& title, double cell_width,
                          double height);

/// One of the two sides a grasp is drawn from: obliquely from behind the hand, its left or its right.
enum class GraspSide { left, right };

/// Hand and object in the object's frame, with the contact points and the normals that point into the object. The
/// object hides nothing: fingers behind it show through. object must have geometry.
std::string draw_grasp(const robot::RobotModel& hand, const RobotFacets& facets, const robot::SceneBody& object,
                       const Grasp& grasp, GraspSide side, const std::string& title, double width, double height);

}  // namespace opponens::report
