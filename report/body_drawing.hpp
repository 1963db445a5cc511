// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "report/facets.hpp"
#include "report/picture.hpp"
#include "robot/robot_model.hpp"

namespace opponens::report {

/// Names of the fingers, in the order of their tips: what a tip calls its finger, else the tip's own name.
std::vector<std::string> finger_names(const robot::RobotModel& model);

/// [links] index into finger_names: of the finger whose tip is on the link or beyond it; -1 where there is none, or
/// more than one (the palm).
std::vector<int> finger_of_links(const robot::RobotModel& model);

/// Indices into body_paints(): robot grey, hand darker, a tint for each finger, object orange, obstacles light.
enum BodyPaint { paint_arm, paint_palm, paint_finger, paint_object = paint_finger + 5, paint_obstacle, paint_support };

std::vector<Paint> body_paints();

/// The links' surfaces as they will be drawn, made once for many pictures.
struct RobotFacets {
  std::vector<std::vector<Facet>> links;  ///< by link index, in the link's frame
};

/// max_triangles: of all meshes of the robot together; finer ones are simplified.
RobotFacets robot_facets(const robot::RobotModel& model, int max_triangles);

/// Appends the robot at q [d] rad with its root at X_WR.
void append_robot(std::vector<Facet>& out, const robot::RobotModel& model, const RobotFacets& facets,
                  const Eigen::Isometry3d& X_WR, const Eigen::VectorXd& q);

/// All corners of facets: what a view has to show.
std::vector<Eigen::Vector3d> corners_of(const std::vector<Facet>& facets);

/// A configuration of the model from values given by joint name: a joint without a value keeps base's. Not clipped to
/// the joint limits. Throws std::invalid_argument for a name that the model lacks. base: [d] rad.
Eigen::VectorXd by_name(const robot::RobotModel& model, const std::vector<std::string>& names,
                        const Eigen::VectorXd& values, const Eigen::VectorXd& base);

/// Zero, clipped to the joint limits.
Eigen::VectorXd rest_configuration(const robot::RobotModel& model);

}  // namespace opponens::report
