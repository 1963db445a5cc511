// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "grasp/body_distance.hpp"
#include "grasp/distance_grid.hpp"
#include "grasp/point_tree.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// A branch of the hand's tree below the palm: the links and the hand joints (indices into q) that move them.
struct Finger {
  std::vector<int> links;   ///< topological order
  std::vector<int> joints;  ///< indices into q, ascending distance from the palm
};

/// What moves a link against its parent: q[index] times multiplier (and an offset that does not matter here).
struct LinkDrive {
  int index = -1;  ///< into q; -1: nothing does
  double multiplier = 1.0;
};

/// The shape of a link, in its frame. Links of the same shape share one.
struct LinkShape {
  explicit LinkShape(const std::vector<robot::Geometry>& geometry);

  std::vector<Eigen::Vector3d> sparse;  ///< points of the surface 20 mm apart: objective
  std::vector<Eigen::Vector3d> coarse;  ///< 9 mm apart: constraints of precision grasps
  PointTree points;                     ///< 2.5 mm apart: closing and verdicts
  BodyDistance body;
  std::unique_ptr<const DistanceGrid> grid;  ///< of meshes, whose distance is slow; null: body is fast enough

  /// Signed distance as a closing hand asks for it: on the grid where there is one, within error() of the truth there
  /// and never more than error() above it.
  double rough(const Eigen::Vector3d& p_L) const;
  double error() const { return grid ? grid->error() : 0.0; }
};

/// What the search knows of a hand, made once: points on its surface, its fingers, the way its palm looks.
struct HandSurface {
  std::vector<std::shared_ptr<const LinkShape>> shapes;  ///< per link
  std::vector<Eigen::Vector3d> link_center;              ///< p_L: middle of the link's bounding box ...
  std::vector<double> link_radius;          ///< ... and radius, m, of a sphere about it that holds the link
  std::vector<std::vector<int>> strangers;  ///< per link: links that it must not touch
  std::vector<int> palm_links;              ///< fixed to the palm, itself included
  std::vector<Finger> fingers;
  std::vector<LinkDrive> drives;         ///< per link
  std::vector<std::vector<bool>> moves;  ///< [link][index in q]: that joint moves that link
  Eigen::Vector3d palm_center;           ///< p_H: mean of the palm's contact points
  Eigen::Vector3d approach;              ///< unit, in H: out of the palm, towards the object
};

/// The palm must be the model's root (load_hand). Without palm contact points, palm_center is the palm's origin and
/// approach the mean normal of all contact points at the configuration q.
HandSurface hand_surface(const robot::RobotModel& hand, const Eigen::VectorXd& q);

}  // namespace opponens::grasp
