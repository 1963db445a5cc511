// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What several of the robot module's tests use.
#pragma once

#include <string>

#include <Eigen/Geometry>

namespace opponens::robot {

/// A file of the repository's models.
inline std::string ours(const std::string& file) { return OPPONENS_SOURCE_DIR "/models/" + file; }

inline Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

}  // namespace opponens::robot
