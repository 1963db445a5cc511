// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robot/geometry.hpp"

namespace opponens::robot {

struct SceneBody {
  std::string name;
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  std::vector<Geometry> geometry;  ///< in the body frame B
};

/// Bodies around a robot. The object to grasp is one of them, named by the user's --object.
struct Scene {
  std::string name;
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();  ///< robot root in the world
  std::vector<SceneBody> bodies;
  std::string object;                     ///< default object to grasp; may be empty
  std::string support;                    ///< body the object stands on; may be empty
  Eigen::VectorXd start;                  ///< [d] rad start configuration by the robot's joint order; empty: not given
  std::vector<std::string> start_joints;  ///< names for start
  std::vector<std::filesystem::path> files;  ///< it was read from, meshes included
  std::vector<std::string> notes;            ///< what of an imported scene was ignored or assumed

  const SceneBody& body(const std::string& name) const;  ///< throws std::invalid_argument when absent
};

/// Reads a scene in any of the forms of docs/scene_files.md and tells which by itself: our YAML, a MoveIt planning
/// scene in YAML (MotionBenchMaker's scenes are such), or MoveIt's .scene text. Throws InputError naming file, body and
/// field.
Scene load_scene(const std::filesystem::path& scene_yaml);

}  // namespace opponens::robot
