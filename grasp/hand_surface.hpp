// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "grasp/body_distance.hpp"
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

/// What the search knows of a hand, made once: points on its surface, its fingers, the way its palm looks.
struct HandSurface {
  std::vector<std::vector<Eigen::Vector3d>> sparse;  ///< per link, p_L, 20 mm apart: objective
  std::vector<std::vector<Eigen::Vector3d>> coarse;  ///< 9 mm apart: fingers against each other while closing
  std::vector<std::vector<Eigen::Vector3d>> medium;  ///< 5 mm apart: closing
  std::vector<std::vector<Eigen::Vector3d>> dense;   ///< 2.5 mm apart: verdicts
  std::vector<BodyDistance> links;                   ///< per link, in its frame
  std::vector<Eigen::Vector3d> link_center;          ///< p_L: middle of the link's bounding box ...
  std::vector<double> link_radius;                   ///< ... and radius, m, of a sphere about it that holds the link
  std::vector<std::vector<int>> strangers;           ///< per link: links that it must not touch
  std::vector<int> palm_links;                       ///< fixed to the palm, itself included
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
