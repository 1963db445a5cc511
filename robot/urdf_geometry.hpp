// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "robot/geometry.hpp"
#include "robot/read_urdf.hpp"

namespace urdf {
class Geometry;
class Link;
class Mesh;
class Pose;
class Vector3;
}  // namespace urdf

namespace opponens::robot {

/// Meshes already read, by path and scale.
using MeshCache = std::map<std::tuple<std::string, double, double, double>, std::shared_ptr<const TriangleMesh>>;

[[noreturn]] void fail_urdf(const std::filesystem::path& file, const std::string& message);

Eigen::Vector3d vector_of(const urdf::Vector3& v);
Eigen::Isometry3d urdf_pose(const urdf::Pose& pose, const std::filesystem::path& file, const std::string& element);

/// Reads the shapes of one URDF's links.
class ShapeReader {
 public:
  ShapeReader(std::filesystem::path file, const UrdfSettings& settings) : file_(std::move(file)), settings_(settings) {}

  /// The shapes of a link, of the kind that the settings ask for.
  std::vector<Geometry> shapes_of(const urdf::Link& link);
  /// Meshes passed over so far; always empty when the settings refuse them.
  const std::vector<MissingMesh>& missing() const { return missing_; }

 private:
  template <typename Elements>
  std::vector<Geometry> shapes(const Elements& elements, const std::string& link);
  std::optional<Shape> shape(const urdf::Geometry& geometry, const std::string& link);
  std::optional<Shape> mesh(const urdf::Mesh& mesh, const std::string& link);

  std::filesystem::path file_;
  UrdfSettings settings_;
  MeshCache cache_;
  std::vector<MissingMesh> missing_;
};

}  // namespace opponens::robot
