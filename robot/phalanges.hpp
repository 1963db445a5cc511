// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "robot/finger_body.hpp"
#include "robot/hand_outline.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// A bone of a finger with its surface, in the palm frame, joints at rest.
struct Phalanx {
  int joint = -1;        ///< that turns it, index into the description
  double sense = 1.0;    ///< +1 or -1: the joint's sense in which the finger closes
  HandBody body;         ///< with vertices
  Eigen::Vector3d bone;  ///< unit, from the joint towards the tip
  Eigen::Vector3d side;  ///< unit, perpendicular to bone: where the pad is
  double from = 0.0;     ///< m, coordinates along bone between which the pad lies
  double to = 0.0;

  Eigen::Vector3d across() const { return bone.cross(side); }
};

struct FingerBones {
  std::string name;
  bool thumb = false;
  std::vector<int> joints;         ///< all its moving joints, indices into the description, palm first
  std::vector<Phalanx> phalanges;  ///< palm first; empty when no body of the finger has geometry
  std::vector<std::string> notes;

  /// Middle of the last phalanx's surface; phalanges must not be empty.
  Eigen::Vector3d end() const { return phalanges.back().body.vertices.rowwise().mean(); }
};

/// Directions of the palm that the fingers tell (thumbs are asked only where there is nothing else), unit, in the palm
/// frame. Zero where the fingers do not agree.
struct PalmDirections {
  Eigen::Vector3d side;   ///< out of the palm, to an object
  Eigen::Vector3d ahead;  ///< along the fingers
};
PalmDirections palm_directions(const std::vector<FingerBones>& fingers);

/// Link poses in the palm frame with all joints at zero, clipped to the limits.
std::vector<Eigen::Isometry3d> rest_in_palm(const RobotModel& robot);

/// The fingers' phalanges as propose_contacts.hpp defines them. X_PL: link poses in the palm frame, joints at rest.
/// Where neither tips nor the URDF's names say which finger is which (finger_1, ...), of three to five fingers one that
/// points and closes unlike all others is taken for the thumb, and the others, in their order from its end on, for
/// index, middle, ring and little; the notes say so.
std::vector<FingerBones> finger_bones(const RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_PL);

}  // namespace opponens::robot
