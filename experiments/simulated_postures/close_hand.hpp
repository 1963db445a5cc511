// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "distance.hpp"
#include "robot/robot_model.hpp"

namespace simulated_postures {

/// Three flexion joints and the three segments they move, from the palm outwards. The thumb's first is T_ABD, which
/// closes by turning back.
struct Finger {
  std::string name;
  std::vector<int> joints;  ///< indices into q
  std::vector<Capsule> segments;
  Eigen::Vector3d tip;  ///< in the frame of the last segment's link, m
};

struct Hand {
  explicit Hand(opponens::robot::RobotDescription description);
  int channel(const std::string& name) const;  ///< index into q; throws std::invalid_argument when absent

  opponens::robot::RobotModel model;
  std::map<std::string, Finger> fingers;  ///< thumb, index, middle, ring, little
};

enum class Place { palm, tips, rim, index };

struct GraspSpec {
  Place place = Place::palm;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();          ///< m, palm frame
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();       ///< of the object's z, palm frame; rim: not used
  Eigen::VectorXd start;                                 ///< [d] rad
  std::vector<std::string> fingers;                      ///< that close, before the thumb does
  Eigen::Vector3d rate = Eigen::Vector3d::Ones();        ///< degrees per step
  Eigen::Vector3d thumb_rate = Eigen::Vector3d::Ones();  ///< degrees per step, of T_ABD, T_MCP, T_IP
};

struct Closed {
  Eigen::VectorXd posture;            ///< [d] rad
  std::vector<std::string> touching;  ///< links within 1 mm of the object
};

/// Pose of the object in the palm frame. Against the palm: moved outwards until the fingers at the start are clear of
/// it; between the tips: its thin side along the line from thumb to fingers, moved towards the thumb until they are.
Eigen::Isometry3d place_object(const Hand& hand, const opponens::robot::Shape& object, const GraspSpec& spec);

/// Closes the fingers, then the thumb. Each joint turns by its rate until its next step would press a segment of its
/// finger into the object or (beyond the first segment) into the palm, the thumb's also into another finger, or its
/// limit is reached; then it stays. A finger that misses the object takes the flexions of its neighbour. Throws
/// std::runtime_error when a closing finger starts inside the object or the first one misses it.
Closed close_hand(const Hand& hand, const opponens::robot::Shape& object, const GraspSpec& spec);

}  // namespace simulated_postures
