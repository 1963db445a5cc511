// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// A chain of moving joints that leaves the palm.
struct FingerChain {
  std::string name;         ///< of its tip's finger, else what its links are called ("thumb", ...), else "finger_1"
  std::vector<int> joints;  ///< indices of its moving joints (mimicking ones too), palm first; not empty
  bool thumb = false;       ///< by its name
};

/// The link that fingers branch from: going from the root along the only moving joint that leads on to geometry, the
/// first rigid body that two or more moving joints leave; of its links the one that most of them hang on. Where
/// branches branch again (two arms on a stand), the body of the last branching with the most fingers, the first of
/// equals. Empty when nothing branches.
std::optional<int> find_palm(const RobotDescription& description);

/// The fingers of the palm: each moving joint that leaves its rigid body away from the root starts one, which follows
/// the longest chain of moving joints (the file's first of equals). Where the description has tips, chains
/// without one are no fingers, and the tips give the names.
std::vector<FingerChain> fingers_of(const RobotDescription& description, int palm);

}  // namespace opponens::robot
