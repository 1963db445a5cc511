// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Exact signed distance to a triangle mesh, by a bounding volume tree and angle-weighted pseudonormals
/// (Baerentzen and Aanaes 2005, doi:10.1109/TVCG.2005.49). Negative inside a closed mesh. Immutable, thread-safe.
/// Where the nearest feature is an edge of more than two triangles or a vertex in which parts of the surface merely
/// touch, no normal tells the sign and the winding number does, in O(F). The mesh has to be free of self-intersections
/// for the sign: of overlapping components, the nearest surface decides.
class MeshDistance {
 public:
  struct Query {
    double distance;           ///< m, signed
    Eigen::Vector3d point;     ///< nearest surface point
    Eigen::Vector3d gradient;  ///< unit, of the signed distance: out of the mesh
    int triangle;
  };

  explicit MeshDistance(std::shared_ptr<const TriangleMesh> mesh);
  ~MeshDistance();
  MeshDistance(MeshDistance&&) noexcept;
  MeshDistance& operator=(MeshDistance&&) noexcept;

  Query query(const Eigen::Vector3d& p) const;
  /// The same, sooner, for a point that is known to be nearer to the surface than `within` (m).
  Query query(const Eigen::Vector3d& p, double within) const;
  double signed_distance(const Eigen::Vector3d& p) const { return query(p).distance; }
  bool inside(const Eigen::Vector3d& p) const { return query(p).distance < 0.0; }
  const TriangleMesh& mesh() const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace opponens::robot
