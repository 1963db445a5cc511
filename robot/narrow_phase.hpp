// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/convex_hull.hpp"
#include "robot/geometry.hpp"
#include "robot/sphere_tree.hpp"

namespace opponens::robot {

class BoundingVolumeTree;

/// A shape prepared for collision queries: FCL geometry, bounding volumes, and for meshes the solids that their closed
/// components enclose. Cheap to copy, immutable, thread-safe. What takes long to make is made when it is needed first,
/// and is shared by all that are made of the same mesh (the same object in memory) while one of them lives.
class CollisionShape {
 public:
  explicit CollisionShape(const Shape& shape);

  struct Bounds {
    Eigen::Vector3d center;        ///< m, of the bounding box and sphere, in G
    Eigen::Vector3d half_extents;  ///< m, of the bounding box along G's axes
    double radius;                 ///< m, of the bounding sphere about center
  };
  const Eigen::Vector3d& center() const { return bounds_.center; }
  const Eigen::Vector3d& half_extents() const { return bounds_.half_extents; }
  double radius() const { return bounds_.radius; }

  /// Balls that contain the solid.
  const SphereTree& cover() const;
  /// Vertices of a mesh's convex hull; throws std::invalid_argument for a primitive.
  const HullVertices& hull() const;
  /// [nodes of cover()] of a mesh, convex hulls that contain its surface together (MeshCover); of a primitive none.
  const std::vector<HullVertices>& pieces() const;
  const Shape& shape() const;
  /// Of a mesh; throws std::invalid_argument for a primitive.
  const BoundingVolumeTree& triangles() const;

  /// A mesh with a component that is not closed: that component is a surface without an inside.
  bool open_surface() const;

  struct Data;
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
  Bounds bounds_;
};

/// Whether two solids share a point: FCL (closed forms, GJK of libccd with its tolerance of 1e-6 m, or triangle tests;
/// for a sphere and a mesh our exact tree instead, which agrees with it and is ten times faster), then containment,
/// which FCL's mesh surfaces do not see. Containment tests one point per connected component, enough once the surfaces
/// are known to be apart. Points count as inside a mesh when they lie in more of its closed components than of its
/// cavities, so meshes whose parts overlap are solid throughout.
bool intersect(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
               const Eigen::Isometry3d& X_WB);

/// Its last part: whether one contains the other, after their surfaces were found apart.
bool contained(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
               const Eigen::Isometry3d& X_WB);

/// Its first part for two meshes, of the triangles in leaves of their covers (and some beside): FCL's verdict on each
/// pair of triangles.
bool leaves_meet(const CollisionShape& a, const Eigen::Isometry3d& X_WA, int leaf_a, const CollisionShape& b,
                 const Eigen::Isometry3d& X_WB, int leaf_b);

/// Distance between two solids, m; 0 when they intersect, and at least 1e-9 when they do not (a distance can round to
/// nothing where the collision test still tells the two apart). With a primitive: a proven lower bound within 1e-7 m of
/// the distance (convex_distance; fcl::distance was seen to err by 24 mm for cylinders). A sphere and a mesh: exact.
/// Two meshes: fcl::distance, which is exact for triangles.
double separation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB);

/// Distance between two meshes' triangles in leaves of their covers (and some beside), by fcl::distance, which is exact
/// for triangles; m, or `limit` when they are not nearer, 0 where they meet.
double leaves_distance(const CollisionShape& a, const Eigen::Isometry3d& X_WA, int leaf_a, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, int leaf_b, double limit);

/// Bounds of the distance of two solids, m; `upper` is infinite where none was looked for.
struct GapBounds {
  double lower;
  double upper;
};

/// m. What is not FCL must find two solids further apart than this to settle that they are: above the tolerance of
/// FCL's tests (1e-6), so that the verdict is FCL's, with or without it.
inline constexpr double kCullMargin = 2e-6;

/// A box with its centre and orientation in the world.
struct OrientedBox {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;  ///< columns, orthonormal
  Eigen::Vector3d half_extents;
};

/// Lower bound of the distance from a point to a box; 0 inside. Exact.
double point_box_distance(const Eigen::Vector3d& p, const OrientedBox& box);

/// Lower bound of the distance of two boxes: the most that the normals of their faces keep them apart, m.
double box_gap(const OrientedBox& a, const OrientedBox& b);

/// Whether one of the 15 axes of the separating axis theorem keeps two boxes more than margin apart (Gottschalk 1996).
bool boxes_apart(const OrientedBox& a, const OrientedBox& b, double margin);

}  // namespace opponens::robot
