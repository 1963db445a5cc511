// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/rng.hpp"
#include "core/synergies.hpp"
#include "grasp/grasp_objective.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// What seeds are drawn for; refers to the caller's values.
struct SeedSpace {
  const robot::RobotModel& hand;
  const HandSurface& surface;
  const GraspTarget& target;
  const SynergyBox& box;
};

/// Palm in front of a point of the object's surface (uniform by area; one in four as seen along a principal axis of the
/// object) and facing it within 0.5 rad, random roll,
/// standoff up to 8 cm, fingers anywhere in the box; out of 20 tries one whose palm is clear of object and obstacles.
std::optional<HandSeed> draw_seed(const SeedSpace& space, Rng& rng);

/// Of eight seeds the one with the least cost; nullopt when none was found.
std::optional<HandSeed> best_seed(const SeedSpace& space, GraspObjective& objective, Rng& rng);

}  // namespace opponens::grasp
