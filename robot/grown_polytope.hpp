// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: how deep two convex solids overlap at least.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace opponens::robot {

/// A convex polytope about the origin, which grows by one corner after the other where its surface is nearest (van den
/// Bergen 2001, "Proximity queries and penetration depth computation on 3D game objects").
class GrownPolytope {
 public:
  static constexpr int kCorners = 14;  ///< at most

  struct Face {
    std::array<int, 3> corners;
    Eigen::Vector3d normal;  ///< unit, outwards
    double distance;         ///< m, of its plane from the origin
  };

  /// Corners of a tetrahedron that contains the origin.
  explicit GrownPolytope(const std::array<Eigen::Vector3d, 4>& corners);

  /// The face whose plane is nearest to the origin: a ball with that distance as its radius is inside the polytope.
  const Face& nearest() const;
  /// Adds a corner beyond the nearest face. Returns false, and is of no further use, when there is no room, when a face
  /// would have no area, or when rounding tears the surface.
  bool add(const Eigen::Vector3d& corner);

 private:
  static constexpr int kFaces = 2 * kCorners;

  bool add_face(int a, int b, int c);

  std::array<Eigen::Vector3d, kCorners> corners_;
  std::array<Face, kFaces> faces_;
  int corner_count_ = 0;
  int face_count_ = 0;
  bool sound_ = true;
};

/// Whether the polytope with these corners, grown by support(n), the point farthest along n, of a convex set that holds
/// them, comes to hold a ball of the radius about the origin. False: not found.
template <typename Support>
bool comes_to_hold_ball(const std::array<Eigen::Vector3d, 4>& corners, double radius, const Support& support) {
  GrownPolytope polytope(corners);
  for (;;) {
    const GrownPolytope::Face& face = polytope.nearest();
    if (face.distance > radius) return true;
    const Eigen::Vector3d corner = support(face.normal);
    if (!(corner.dot(face.normal) > radius) || !polytope.add(corner)) return false;
  }
}

}  // namespace opponens::robot
