// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "robot/geometry.hpp"
#include "robot/read_urdf.hpp"

namespace urdf {
class Link;
class Pose;
class Vector3;
}  // namespace urdf

namespace opponens::robot {

/// Meshes already read, by path and scale.
using MeshCache = std::map<std::tuple<std::string, double, double, double>, std::shared_ptr<const TriangleMesh>>;

[[noreturn]] void fail_urdf(const std::filesystem::path& file, const std::string& message);

Eigen::Vector3d vector_of(const urdf::Vector3& v);
Eigen::Isometry3d urdf_pose(const urdf::Pose& pose, const std::filesystem::path& file, const std::string& element);

/// The shapes of a link, of the kind that the settings ask for.
std::vector<Geometry> geometry_of(const urdf::Link& link, const std::filesystem::path& file,
                                  const UrdfSettings& settings, MeshCache& cache);

}  // namespace opponens::robot
