// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: MoveIt's planning scenes as YAML (moveit_msgs/PlanningScene).

#include <vector>

#include "robot/read_urdf.hpp"
#include "robot/scene.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

/// Whether a YAML file is a planning scene: a map with the key world.
bool is_planning_scene(const YamlValue& root);

/// The bodies of world.collision_objects in the planning frame, and robot_state as start. What has no counterpart here
/// (allowed collision matrix, padding, octomap, subframes, attached objects) is counted in the notes.
Scene read_planning_scene(const YamlValue& root, const PackagePaths& packages);

/// The shapes of one collision object, in the object's frame O: primitives with primitive_poses, meshes with
/// mesh_poses. Dimensions in MoveIt's order: box [x, y, z], sphere [radius], cylinder and cone [height, radius].
std::vector<Geometry> planning_scene_shapes(const YamlValue& object, const PackagePaths& packages);

/// A position and an orientation, both needed.
Eigen::Isometry3d ros_pose(const YamlValue& value);

/// A solid cone along z with its apex up and its middle height at the origin, as a mesh that contains it: the polygon
/// of 64 sides goes round the circle, 0.12 % wider.
Shape cone(double radius, double height);

}  // namespace opponens::robot
