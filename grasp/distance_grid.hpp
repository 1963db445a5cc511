// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "grasp/body_distance.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::grasp {

/// Signed distance to a mesh sampled on a grid, for the many queries of a search: trilinear between nodes, with the
/// exact gradient of that interpolant (so value and gradient agree). Its error is below spacing/2 near edges and far
/// smaller on flat or gently curved surfaces; decisions about contact are made with MeshDistance. Outside the grid: the
/// value at the nearest grid point plus the distance to it. 20-30 ns per query. Immutable.
class DistanceGrid {
 public:
  struct Layout {
    double spacing;         ///< m, enlarged when the grid would hold more than max_nodes
    double margin;          ///< m around the box
    std::size_t max_nodes;  ///< at least 8
  };
  /// distance: of any body inside the box, m; asked at the nodes.
  DistanceGrid(const std::function<double(const Eigen::Vector3d&)>& distance, const Eigen::AlignedBox3d& box,
               const Layout& layout, int threads);
  DistanceGrid(const robot::MeshDistance& mesh, const Layout& layout, int threads);

  SignedDistance query(const Eigen::Vector3d& p) const;
  double value(const Eigen::Vector3d& p) const;  ///< the same without gradient, twice as fast
  /// Inside the grid the value, outside a lower bound of the distance (but for error()) instead of an upper one.
  double bound(const Eigen::Vector3d& p) const;
  bool holds(const Eigen::Vector3d& p) const {
    return (p.array() >= lower_.array()).all() && (p.array() <= upper_.array()).all();
  }
  double spacing() const { return spacing_; }
  /// Bound of |value - distance| inside the grid, m: the nodes are exact, the distance changes by at most 1 m per m,
  /// and a weighted mean of the nodes' distances from a point of a cell is largest in its middle.
  double error() const { return 0.8661 * spacing_; }

 private:
  struct Cell {
    const float* node;         ///< lowest corner
    Eigen::Vector3d fraction;  ///< in [0, 1]
    Eigen::Vector3d inside;    ///< p clamped to the grid
  };
  Cell locate(const Eigen::Vector3d& p) const;
  double interpolate(const Cell& cell) const;

  double spacing_;
  double cells_per_meter_;
  double margin_;
  Eigen::Vector3d lower_;
  Eigen::Vector3d upper_;
  Eigen::Vector3i count_;
  std::vector<float> nodes_;
};

}  // namespace opponens::grasp
