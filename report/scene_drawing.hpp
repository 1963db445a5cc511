// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "report/body_drawing.hpp"
#include "report/picture.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::report {

/// A robot and a scene as they will be drawn, made once for many pictures.
struct DrawnScene {
  RobotFacets robot;
  std::vector<Facet> bodies;                  ///< in the world
  std::vector<Eigen::Vector3d> surroundings;  ///< m, world: corners of the bodies that a picture should show
};

/// objects: the bodies painted as objects. The scene's support has its own paint. Bodies larger than 0.5 m
/// (floors, furniture) are drawn, but the picture is not zoomed out for them.
DrawnScene drawn_scene(const robot::RobotModel& robot, const robot::Scene& scene,
                       const std::vector<std::string>& objects, int max_triangles);

/// A camera direction relative to the horizontal direction from the robot's root to the middle of the objects: azimuth
/// 0 looks over the robot's shoulder at the object, positive from the left.
struct Camera {
  double azimuth = 0.0;    ///< rad
  double elevation = 0.0;  ///< rad above the horizon
};

/// The view that shows the robot at each of the configurations, and the surroundings.
View scene_view(const robot::RobotModel& robot, const robot::Scene& scene, const std::vector<std::string>& objects,
                const DrawnScene& drawn, const Camera& camera, const std::vector<Eigen::VectorXd>& configurations,
                double width, double height);

/// Points joined by a line, e.g. where a palm passes, m, in the world.
using Trail = std::vector<Eigen::Vector3d>;

/// Robot at q with the scene and the trails. Robot and object
/// show faintly through what hides them.
std::string draw_scene(const robot::RobotModel& robot, const robot::Scene& scene, const DrawnScene& drawn,
                       const View& view, const Eigen::VectorXd& q, const std::vector<Trail>& trails,
                       const std::string& title);

}  // namespace opponens::report
