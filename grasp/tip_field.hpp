// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "grasp/distance_grid.hpp"

namespace opponens::grasp {

struct FieldSample {
  double value;              ///< m, about the signed distance
  Eigen::Vector3d gradient;  ///< of value, exactly
  Eigen::Matrix3d hessian;   ///< 1/m, of value, exactly
};

/// A twice continuously differentiable signed distance for an optimiser that needs the turning of surface normals:
/// uniform cubic B-spline with the gridded distance as its coefficients (de Boor 1978, chapter IX). It is the grid
/// smoothed over one spacing h: a flat face is kept exactly, a face of curvature c is moved by about h^2 c / 6, a sharp
/// edge becomes round. Decisions about contact are made with MeshDistance. Beyond the lattice: the value at its
/// nearest point plus the distance to it. About 0.2 us per query. Immutable.
class TipField {
 public:
  /// lower, upper: corners of the box to cover, m; spacing: m, enlarged where the lattice would pass max_nodes.
  TipField(const DistanceGrid& grid, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double spacing,
           std::size_t max_nodes);

  FieldSample query(const Eigen::Vector3d& p) const;

 private:
  double spacing_;
  Eigen::Vector3d first_;          ///< node 0
  Eigen::Vector3d lower_, upper_;  ///< where the spline has all its nodes
  Eigen::Vector3i count_;
  std::vector<float> nodes_;
};

}  // namespace opponens::grasp
