// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"
#include "verify/penetration.hpp"
#include "verify/solid.hpp"

namespace opponens::verify {

/// verify's own collision world: every geometry of robot and scene as triangles that contain it (circumscribed), with
/// an FCL tree (spheres are a centre and a radius instead), a bounding ball and a bounding box; equal shapes share
/// theirs. Built once for a robot and a scene; place() moves it. Both are referred to and must outlive it.
class Bodies {
 public:
  Bodies(const robot::RobotModel& robot, const robot::Scene& scene);
  ~Bodies();

  /// Two geometries that must not touch, unless a grasp says so: indices of parts; the first belongs to a link.
  struct Pair {
    int first;
    int second;
  };
  /// A point of each surface, in its geometry's frame.
  struct NearPoints {
    Eigen::Vector3d first;
    Eigen::Vector3d second;
  };
  /// Any two points of a pair.
  NearPoints points(const Pair& pair) const;
  /// All of them, but for the robot's allowed collisions and those within a link.
  const std::vector<Pair>& pairs() const;
  const std::string& name(int part) const;  ///< of its link or scene body
  int link(int part) const;                 ///< -1: of the scene

  /// Link poses in the robot's root frame.
  void place(const std::vector<Eigen::Isometry3d>& X_RL);

  /// A lower bound of the distance from bounding balls and boxes alone, m; 0 where they meet. Where the balls alone
  /// give `enough`, nothing better is looked for.
  double gap(const Pair& pair, double enough) const;
  /// Distance between the two surfaces, m, or `bound` when that is less; 0 when they meet. By fcl::distance between
  /// trees of triangles, which is exact there (between FCL's primitives it was seen to be off by 24 mm); of a sphere,
  /// by that of its centre from the other's triangles. Not larger than the distance of the shapes, and less by 0.02 mm
  /// at most for each round one.
  double distance(const Pair& pair, double bound) const;
  /// The same; where it is FCL's and below `bound`, `near` is set to where the surfaces are nearest to each other.
  double distance(const Pair& pair, double bound, NearPoints& near) const;
  /// m, of a vertex of the finer surface that lies near to the other's box, from that other surface; `bound` when that
  /// is less. The distance does not exceed it, and it costs little.
  double approach(const Pair& pair, double bound) const;
  /// m, between two points of a pair, which its distance does not exceed.
  double apart(const Pair& pair, const NearPoints& points) const;
  /// Whether a component of one lies inside the other, given that the surfaces are apart.
  bool contained(const Pair& pair) const;
  /// Depth of either in the other; see penetration().
  Depth depth(const Pair& pair, double enough) const;

 private:
  struct Part;
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace opponens::verify
