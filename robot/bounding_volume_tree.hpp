// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::robot {

/// Part of a triangle that holds its point nearest to another: vertex 0-2, edge 3-5 (edge 3 + k joins vertices k and
/// k + 1 mod 3), or the inside of the face.
enum class TriangleFeature { vertex_0, vertex_1, vertex_2, edge_01, edge_12, edge_20, face };

struct TrianglePoint {
  Eigen::Vector3d point;
  TriangleFeature feature;
};

/// Nearest point of the triangle (a, a + ab, a + ac) to p, by Voronoi regions (Ericson 2005, Real-Time Collision
/// Detection, section 5.1.5). A triangle without area is treated as its edges.
TrianglePoint nearest_on_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac,
                                  const Eigen::Vector3d& p);

/// Binary tree of axis-aligned boxes over the triangles of a mesh, split by the surface area heuristic in 16 bins, with
/// at most 4 triangles per leaf. Immutable; build O(F log F).
class BoundingVolumeTree {
 public:
  struct Nearest {
    double squared_distance;  ///< m^2
    Eigen::Vector3d point;
    int triangle;  ///< index in the mesh
    TriangleFeature feature;
  };

  explicit BoundingVolumeTree(const TriangleMesh& mesh);

  /// Exact nearest point of the surface nearer than `within` (m); of equally near triangles the one met first, which is
  /// always the same, whatever the bound. triangle = -1: there is none.
  Nearest nearest(const Eigen::Vector3d& p, double within = std::numeric_limits<double>::infinity()) const;

  /// A lower bound of the distance from the box with these centre and half extents to something, m.
  using BoxBound = std::function<double(const Eigen::Vector3d& center, const Eigen::Vector3d& half_extents)>;
  /// Distance from the triangle (a, a + ab, a + ac) to it, m.
  using TriangleDistance =
      std::function<double(const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac)>;

  /// Least distance of any triangle, or `limit` when none is nearer; those whose boxes are too far away are not asked.
  double least(const BoxBound& bound, const TriangleDistance& distance,
               double limit = std::numeric_limits<double>::infinity()) const;

 private:
  struct Item {
    Eigen::Vector3d lower, upper, center;
    int triangle;
  };
  /// Both children's boxes side by side, so that the two distances are computed together.
  struct Node {
    Eigen::Array<double, 2, 3> lower, upper;  ///< [child x axis] m
    std::array<int, 2> first;                 ///< child is a leaf: first triangle slot; otherwise: node index
    std::array<int, 2> count;                 ///< triangles of a leaf child; 0: an inner node
  };
  struct Slot {
    Eigen::Vector3d a, ab, ac;
    int triangle;
  };

  int build(std::vector<Item>& items, int begin, int end);

  std::vector<Node> nodes_;
  std::vector<Slot> slots_;  ///< triangles in leaf order
};

}  // namespace opponens::robot
