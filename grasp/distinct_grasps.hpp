// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/grasp.hpp"

namespace opponens::grasp {

/// Two grasps count as one when they are nearer than all three: in palm pose and in the hand's shape.
struct GraspDistances {
  double position = 0.01;  ///< m, between the palms' origins in the object's frame
  double angle = 0.2;      ///< rad, of the turn between the palms
  double joints = 0.2;     ///< rad, of the hand joint that differs most
};
void validate(const GraspDistances& distances);  ///< throws std::invalid_argument naming field, value, constraint

/// Whether a and b count as one. Both of the same hand, else std::invalid_argument.
bool same_grasp(const Grasp& a, const Grasp& b, const GraspDistances& distances);

/// What a grasp is worth; nothing where it has no such value.
using GraspWorth = std::function<std::optional<double>(const Grasp&)>;
std::optional<double> worth_by_epsilon(const Grasp& grasp);

/// Indices of at most count grasps, best first: greedily by their worth, each different from all that were taken before
/// it. Of equally good ones the earlier comes first; those without a worth come last. Cost: O(G log G + G count).
std::vector<std::size_t> distinct_grasps(const std::vector<Grasp>& grasps, int count, const GraspDistances& distances,
                                         const GraspWorth& worth = worth_by_epsilon);
/// Those grasps.
std::vector<Grasp> best_distinct(std::vector<Grasp> grasps, int count, const GraspDistances& distances,
                                 const GraspWorth& worth = worth_by_epsilon);

}  // namespace opponens::grasp
