// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace opponens::experiments {

/// What GraspIt!'s best method (random_preshape, 60 s of CPU an object) reached on an object.
struct PeerResult {
  std::vector<double> by_face_normal;  ///< epsilon of its best five rescored with face normals; -1: no closure then
  std::vector<double> by_qhull;        ///< with its own, interpolated normals and clean qhull options
};

/// From reference/graspit_ycb.csv. Throws std::runtime_error naming file and column when it is not of that form.
std::map<std::string, PeerResult> read_peer(const std::filesystem::path& csv);

}  // namespace opponens::experiments
