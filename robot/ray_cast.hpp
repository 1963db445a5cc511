// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "robot/geometry.hpp"

namespace opponens::robot {

struct RayHit {
  double distance;         ///< m, from the origin along the direction
  Eigen::Vector3d normal;  ///< unit, of the surface there, turned against the ray
};

/// Where a ray first meets a geometry, in the body's frame. direction: unit. Origins inside a shape meet its surface
/// from within. Exact on boxes, spheres and cylinders; on meshes by Moeller and Trumbore 1997
/// (doi:10.1080/10867651.1997 .10487468) against every triangle, O(F): of equally near triangles the one that faces the
/// ray most.
std::optional<RayHit> first_hit(const Geometry& geometry, const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction);

}  // namespace opponens::robot
