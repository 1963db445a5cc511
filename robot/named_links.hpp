// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Internal to robot/: names that a YAML file gives, looked up in the tree that a URDF describes. Each complaint is an
// InputError that names file, line and field.
#pragma once

#include <utility>
#include <vector>

#include "robot/hand_file.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

int require_link(const RobotDescription& description, const NamedValue& link);

/// A link named for nothing is a mistyped one, whose shapes would stay. Both: arm and hand may come in two URDFs.
void require_links(const std::vector<NamedValue>& names, const RobotDescription& one, const RobotDescription& other);

/// A joint that moves by itself.
void require_actuated(const RobotDescription& description, const NamedValue& name);

void allow_pairs(RobotDescription& description, const std::vector<std::pair<NamedValue, NamedValue>>& pairs);

/// Palm, joints, surface points, allowed pairs and SRDF of a hand.yaml, and the pairs that are allowed anyhow.
void fill_hand(RobotDescription& description, const HandFile& hand);

/// Appends the SRDFs and the meshes to the description's files.
void add_files_inside(RobotDescription& description);

}  // namespace opponens::robot
