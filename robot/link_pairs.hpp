// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Index of the link with this name.
std::optional<int> find_link(const RobotDescription& description, const std::string& name);

/// Index of the rigid body (links joined by fixed joints, named by its first link) that each link belongs to.
std::vector<int> rigid_bodies(const RobotDescription& description);

/// Allows what needs no listing: links of one rigid body never move against each other, and the two links of a joint
/// are built to touch.
void allow_adjacent(RobotDescription& description);

}  // namespace opponens::robot
