// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: meshes in FCL's form.
#pragma once

#include <memory>
#include <mutex>

#include "robot/geometry.hpp"
#include "robot/sphere_tree.hpp"

namespace fcl {
template <typename Scalar>
class CollisionGeometry;
}

namespace opponens::robot {

using FclGeometry = std::shared_ptr<fcl::CollisionGeometry<double>>;

/// A mesh, all of it and piece by piece, in trees of boxes that are made when they are asked for first.
/// Throws std::invalid_argument when FCL refuses the mesh. Thread-safe.
class FclMeshes {
 public:
  /// The mesh is referred to and must outlive this.
  explicit FclMeshes(const TriangleMesh& mesh) : mesh_(mesh) {}

  const fcl::CollisionGeometry<double>* whole() const;
  /// All triangles whose boxes reach into the ball of a leaf, hence all in its cell, and some beside it. The cell must
  /// have one, and the tree always be the same.
  const fcl::CollisionGeometry<double>* leaf(const SphereTree& tree, int node) const;

 private:
  struct Lazy {
    std::once_flag once;
    FclGeometry made;
  };
  const TriangleMesh& mesh_;
  mutable Lazy whole_;
  mutable std::once_flag leaves_once_;
  mutable std::unique_ptr<Lazy[]> leaves_;  ///< [nodes]
};

}  // namespace opponens::robot
