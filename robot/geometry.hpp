// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace opponens::robot {

struct Box {
  Eigen::Vector3d size;  ///< full edge lengths, m
};
struct Sphere {
  double radius;  ///< m
};
struct Cylinder {
  double radius;  ///< m
  double length;  ///< m, along z, centred
};
struct MeshCover;
struct TriangleMesh {
  Eigen::Matrix3Xd vertices;               ///< [3 x V] m
  Eigen::Matrix3Xi triangles;              ///< [3 x F] vertex indices, counter-clockwise seen from outside
  std::string source;                      ///< file or shape it came from, for messages
  std::filesystem::path file;              ///< it was read from; empty: it was made here
  std::shared_ptr<const MeshCover> cover{};  ///< of these triangles (cover_file.hpp); empty: made when it is needed
};

/// Meshes are immutable and shared: the finger links of a hand repeat the same 10,000 triangles.
using Shape = std::variant<Box, Sphere, Cylinder, std::shared_ptr<const TriangleMesh>>;

/// A shape fixed to a body B (a link, or a scene body).
struct Geometry {
  Shape shape;
  Eigen::Isometry3d X_BG = Eigen::Isometry3d::Identity();
};

}  // namespace opponens::robot
