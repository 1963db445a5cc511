// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/geometry.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::grasp {

struct SignedDistance {
  double value;              ///< m, negative inside
  Eigen::Vector3d gradient;  ///< unit where the distance is smooth
};

/// Signed distance from a point to a body made of shapes: closed forms for boxes, spheres and cylinders, MeshDistance
/// for meshes. Outside it is exact; inside a union of shapes it is the deepest single shape's, a lower bound of the
/// depth. Immutable, thread-safe.
class BodyDistance {
 public:
  explicit BodyDistance(const std::vector<robot::Geometry>& geometry);

  bool empty() const { return parts_.empty(); }
  /// Beyond `horizon` from every bounding sphere the answer is a lower bound of the distance, still >= horizon.
  SignedDistance query(const Eigen::Vector3d& p_B, double horizon) const;

 private:
  struct Part {
    std::variant<robot::Box, robot::Sphere, robot::Cylinder, std::shared_ptr<const robot::MeshDistance>> shape;
    Eigen::Isometry3d X_GB;
    Eigen::Vector3d center_B;  ///< of the bounding sphere
    double radius;
  };
  std::vector<Part> parts_;
};

}  // namespace opponens::grasp
