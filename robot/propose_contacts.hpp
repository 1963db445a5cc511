// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace opponens::robot {

struct ContactProposal {
  std::vector<SurfacePoint> tips;            ///< one per finger, named as the finger
  std::vector<SurfacePoint> contact_points;  ///< FINGER_1.. from the palm outwards, FINGER_tip; palm_1..
  std::vector<std::string> notes;            ///< what could not be placed, and what was guessed
};

/// Contact points for a hand that has none, in the paper's layout (Fig. 5): four on each finger (the pads of its last
/// three phalanges and its tip), three on the thumb, three on the palm, fewer where the geometry has no such place. All
/// lie on the surface of the chosen collision geometry (primitives exactly, meshes on a triangle), with the surface's
/// own outward normal there.
///
/// Method. A finger is a chain of moving joints from the palm (hand_outline.hpp). A phalanx is a rigid body whose joint
/// axis a is parallel (within 25 deg, joints at zero clipped to their limits) to that of the finger's last joint. The
/// pad side is the one that moves ahead when the finger closes, a x bone with the sign in which the joint has more
/// range: fingers bend further to the palm than back. A prismatic or evenly ranged last joint closes towards the other
/// fingers. Pads are where rays against that side first meet the body near the middle of the bone, preferring normals
/// along the side's direction. The tip lies where the last body reaches furthest, 30 deg from its end to the pad side
/// (as in models/); given tips are kept, and the
/// contact point is the surface next to them. The palm's side is the mean of the fingers' sides (of their directions
/// where they oppose each other, as grippers' jaws do); its points are far apart on the palm link's flattest patch.
/// A finger is a thumb when its name says so. Deterministic. Cost O(rays x triangles).
ContactProposal propose_contacts(const RobotModel& robot);

}  // namespace opponens::robot
