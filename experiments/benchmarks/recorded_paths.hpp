// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/path.hpp"
#include "robot/load_robot.hpp"
#include "verify/paths.hpp"

namespace opponens::benchmarks {

/// Paths that `opponens plan` found, with what they claim.
struct Recorded {
  std::vector<JointPath> paths;
  std::vector<verify::PathClaim> claims;
};

/// Of a file of this folder (record_paths.py). OPPONENS_BENCHMARK_PATHS: only so many.
Recorded read_paths(const std::string& file, const robot::RobotModel& robot, const std::string& object);

/// The bottle's shelf before a robot.
struct Setting {
  robot::RobotModel robot;
  robot::Scene scene = robot::load_scene(OPPONENS_SOURCE_DIR "/models/scenes/bottle_shelf.yaml");
};
Setting ours();
/// With the laboratory's meshes, which shared data have.
Setting laboratory();

}  // namespace opponens::benchmarks
