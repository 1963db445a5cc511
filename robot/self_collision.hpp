// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/rng.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// How often two links, both with geometry, met over the samples.
struct LinkPairHits {
  int first = -1;         ///< link index, first < second
  int second = -1;        ///< link index
  bool adjacent = false;  ///< of one joint, or of one rigid body: allowed without being listed
  bool allowed = false;   ///< by the description (adjacent ones too)
  bool at_rest = false;   ///< they meet with all joints at zero, clipped to the limits
  int hits = 0;
};

struct SelfCollisionSamples {
  int samples = 0;
  int colliding = 0;                ///< samples at which a pair that is not allowed meets
  std::vector<LinkPairHits> pairs;  ///< every pair of links with geometry, in order of their indices
};

/// Configurations drawn evenly within the joint limits, each checked for every pair of links, allowed or not, by the
/// collision truth. progress(done, samples) is called after each. Cost: samples x pairs. Deterministic.
SelfCollisionSamples sample_self_collisions(const RobotModel& robot, int samples,
                                            const std::function<void(std::size_t, std::size_t)>& progress, Rng& rng);

/// Pairs that are neither adjacent nor allowed yet, by what the samples say of them (as MoveIt's setup assistant sorts
/// them). Each pair is in one list.
struct AllowedSuggestion {
  std::vector<LinkPairHits> always;   ///< met in every sample: their shapes overlap, checking them is of no use
  std::vector<LinkPairHits> at_rest;  ///< met with all joints at zero
  std::vector<LinkPairHits> often;    ///< met in half of the samples or more: coarse shapes? to be looked at
  std::vector<LinkPairHits> never;    ///< met in none: likely (never_bound) but not certainly out of each other's reach
};
AllowedSuggestion suggest_allowed(const SelfCollisionSamples& samples);

/// Largest probability that is compatible with no event in n trials: the p with (1-p)^n = 1 - confidence.
double never_bound(int samples, double confidence = 0.95);

}  // namespace opponens::robot
