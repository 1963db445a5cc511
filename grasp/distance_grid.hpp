// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "grasp/body_distance.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::grasp {

/// Signed distance to a mesh sampled on a grid, for the many queries of a search: trilinear between nodes, with the
/// exact gradient of that interpolant (so value and gradient agree). Its error is below spacing/2 near edges and far
/// smaller on flat or gently curved surfaces; decisions about contact are made with MeshDistance. Outside the grid: the
/// value at the nearest grid point plus the distance to it. 20-30 ns per query. Immutable.
class DistanceGrid {
 public:
  /// spacing: m, enlarged when the grid would hold more than max_nodes. margin: m around the mesh.
  DistanceGrid(const robot::MeshDistance& mesh, double spacing, double margin, std::size_t max_nodes, int threads);

  SignedDistance query(const Eigen::Vector3d& p) const;
  double value(const Eigen::Vector3d& p) const;  ///< the same without gradient, twice as fast
  double spacing() const { return spacing_; }

 private:
  struct Cell {
    const float* node;         ///< lowest corner
    Eigen::Vector3d fraction;  ///< in [0, 1]
    Eigen::Vector3d inside;    ///< p clamped to the grid
  };
  Cell locate(const Eigen::Vector3d& p) const;

  double spacing_;
  Eigen::Vector3d lower_;
  Eigen::Vector3d upper_;
  Eigen::Vector3i count_;
  std::vector<float> nodes_;
};

}  // namespace opponens::grasp
