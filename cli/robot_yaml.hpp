// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cli/robot_facts.hpp"

namespace opponens::cli {

/// Keys tips and contact_points as a hand.yaml holds them, what could not be placed as comments.
std::string contacts_yaml(const robot::RobotModel& model, const robot::ContactProposal& proposal);

/// Key allowed_collisions with the pairs that are neither adjacent nor allowed yet. facts.samples must exist.
std::string allowed_yaml(const RobotFacts& facts);

/// A hand.yaml to start from, with a robot.yaml in comments where an arm leads to the hand, from a URDF alone.
/// facts.proposal and facts.samples must exist.
std::string skeleton_yaml(const RobotFacts& facts);

}  // namespace opponens::cli
