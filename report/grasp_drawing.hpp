// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/grasp.hpp"
#include "report/body_drawing.hpp"
#include "report/grasp_views.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::report {

/// A hand and an object as grasps of the gallery show them, made once for many pictures.
struct GraspStage {
  robot::RobotModel hand;
  RobotFacets facets;
  std::vector<Facet> object;  ///< in O
  std::vector<int> fingers;   ///< [links] index into finger_names, -1: palm
  Eigen::Vector3d up;         ///< unit, the world's up in O
};

/// object must have geometry (std::invalid_argument). Meshes are simplified to 2400 triangles for the hand and 1200 for
/// the object at most: a picture of 36 kB for the demo's bottle.
GraspStage grasp_stage(const robot::RobotModel& hand, const robot::SceneBody& object);

/// Hand and object of a grasp. q_grasp must have the hand's number of joints (std::invalid_argument).
GraspBodies grasp_bodies(const GraspStage& stage, const Grasp& grasp);

/// [m] finger of each contact's link, -1: palm, or a link that the hand lacks.
std::vector<int> contact_fingers(const GraspStage& stage, const Grasp& grasp);

/// The picture from a view: fingers tinted like their contacts, the object hiding nothing, contacts with friction cones
/// and numbers (contact_marks.hpp) over all.
std::string draw_grasp(const GraspStage& stage, const GraspBodies& bodies, const Grasp& grasp, const GraspView& view,
                       const std::string& title, double width, double height);

}  // namespace opponens::report
