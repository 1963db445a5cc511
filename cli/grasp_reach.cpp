// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/grasp_reach.hpp"

#include "motion/goal_configurations.hpp"

namespace opponens::cli {

Reach::Reach(const NamedWorld& world, double max_penetration)
    : world_(world),
      max_penetration_(max_penetration),
      kinematics_(robot::make_inverse_kinematics(world.robot)),
      free_space_(world.robot, world.scene),
      closing_(world.robot, world.scene, world.hand_object_pairs()),
      depth_(world.robot, world.scene, world.touching()),
      X_RO_(world.X_RO()) {}

std::string Reach::operator()(Grasp& grasp) const {
  constexpr double kResolution = 0.02;   // rad, spacing of the checks along a closing segment
  constexpr double kSampledShare = 0.9;  // of the depth that `verify` holds the whole segment to
  return motion::reach(grasp, world_.robot, kinematics_, X_RO_, free_space_, closing_, kResolution,
                       {&depth_, kSampledShare * max_penetration_});
}

}  // namespace opponens::cli
