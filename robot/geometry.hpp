// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
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

/// Where a mesh keeps its cover (cover_file.hpp). A mesh that is copied or moved starts without one, and so does one
/// that another is assigned to: their owners may change them.
class KeptCover {
 public:
  KeptCover() = default;
  KeptCover(const KeptCover& /*other*/) noexcept {}
  KeptCover(KeptCover&& other) noexcept { other.made_ = nullptr; }
  KeptCover& operator=(const KeptCover& /*other*/) noexcept {
    made_ = nullptr;
    return *this;
  }
  KeptCover& operator=(KeptCover&& other) noexcept {
    made_ = other.made_ = nullptr;
    return *this;
  }
  ~KeptCover() = default;

  /// Null: it is made when it is needed.
  const MeshCover* get() const { return made_.get(); }
  /// The mesh must not be changed afterwards.
  void keep(std::shared_ptr<const MeshCover> made) { made_ = std::move(made); }

 private:
  std::shared_ptr<const MeshCover> made_;
};

struct TriangleMesh {
  Eigen::Matrix3Xd vertices;   ///< [3 x V] m
  Eigen::Matrix3Xi triangles;  ///< [3 x F] vertex indices, counter-clockwise seen from outside
  std::string source;          ///< file or shape it came from, for messages
  std::filesystem::path file;  ///< it was read from; empty: it was made here
  KeptCover cover{};           ///< of these triangles
};

/// Meshes are immutable and shared: the finger links of a hand repeat the same 10,000 triangles.
using Shape = std::variant<Box, Sphere, Cylinder, std::shared_ptr<const TriangleMesh>>;

/// A shape fixed to a body B (a link, or a scene body).
struct Geometry {
  Shape shape;
  Eigen::Isometry3d X_BG = Eigen::Isometry3d::Identity();
};

}  // namespace opponens::robot
