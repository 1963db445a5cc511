// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/bounding_volume_tree.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::robot {

/// The solid that a mesh encloses: points that lie in more of its closed components than of its cavities, so meshes
/// whose parts overlap are solid throughout. Open components enclose nothing. Thread-safe.
class SolidRegion {
 public:
  /// The mesh is referred to and must outlive this.
  explicit SolidRegion(const TriangleMesh& mesh);

  bool contains(const Eigen::Vector3d& p) const;
  /// Whether p is inside or within 1e-7 m of any triangle.
  bool touches(const Eigen::Vector3d& p) const;
  /// A vertex of each component.
  const std::vector<Eigen::Vector3d>& seeds() const { return seeds_; }
  /// Whether a component is not closed.
  bool open() const { return !sheets_.empty(); }
  /// All triangles, in a tree that is made when it is first asked for.
  const BoundingVolumeTree& triangles() const;

 private:
  /// What one closed component encloses.
  struct Enclosure {
    Eigen::AlignedBox3d box;
    MeshDistance distance;
    bool outward;         ///< triangles seen counter-clockwise from outside
    bool cavity = false;  ///< it is the wall of a hollow inside another component
    bool encloses(const Eigen::Vector3d& p) const;
  };

  const TriangleMesh& mesh_;
  std::vector<Enclosure> enclosures_;
  std::vector<BoundingVolumeTree> sheets_;  ///< of the components that enclose nothing
  std::vector<Eigen::Vector3d> seeds_;
  mutable std::once_flag triangles_once_;
  mutable std::optional<BoundingVolumeTree> triangles_;
};

}  // namespace opponens::robot
