// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "grasp/distinct_grasps.hpp"
#include "grasp/grasp_check.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::grasp {

struct SearchSettings {
  int count = 5;                   ///< grasps to return
  int max_trials = 2000;           ///< seeds tried; the search stops on this count, never on a clock
  int min_trials = 128;            ///< no early stop before this many, though `count` grasps exist: more trials, better
                                   ///< grasps
  double mu = 0.5;                 ///< friction coefficient
  int edges = 8;                   ///< friction cone edges
  double max_penetration = 0.001;  ///< m, of any hand point into object at the returned grasp
  double contact_tolerance = 0.001;  ///< m, a contact point closer than this to the surface touches
  double clearance_pregrasp = 0.01;  ///< m, least distance hand-object at the pre-grasp
  double slack_bound = 0.3;          ///< rad, 2-norm of a synergy grasp's slack (docs/deviations.md, 6)
  int improvements = 15;             ///< closings from neighbouring poses of each of the best 2 count grasps
  GraspDistances distances;          ///< of returned grasps from each other
  int threads = 1;
};
void validate(const SearchSettings& settings);  ///< throws std::invalid_argument naming field, value, constraint

struct SearchResult {
  std::vector<Grasp>
      grasps;  ///< best first (epsilon; precision grasps: by their goal), arm_solutions as `accept` left them
  std::int64_t trials = 0;
  std::int64_t evaluations = 0;                  ///< of the objective: in choosing seeds, and by NLopt
  std::map<std::string, std::int64_t> rejected;  ///< reason -> count; trials = grasps found + rejected
};

/// Called for each candidate that is force closure: an extra acceptance test (e.g. Algorithm 1's reachability).
/// An empty string accepts; otherwise the reason, which is counted. Must be thread-safe. May fill arm_solutions.
using Accept = std::function<std::string(Grasp&)>;

using SearchProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// What all searches of one hand for one object of a scene share; refers to the caller's hand.
struct SearchWorld {
  const robot::RobotModel& hand;  ///< rooted at the palm (load_hand)
  GraspTarget target;
  HandSurface surface;
  HandCheckers checkers;
};
SearchWorld make_search_world(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object,
                              int threads);

/// Grasps of the scene's object by one hand along the synergies of one group (docs/deviations.md, 5): NLopt over hand
/// pose and the k synergy coordinates, then closing along the synergies until contact, finger by finger, then quality
/// and pre-grasp; the best are improved by closing again from neighbouring poses. Every grasp returned is certified.
/// Deterministic for a seed whatever the thread count.
SearchResult search_grasps(const SearchWorld& world, const SynergyGroup& group, const SynergyBox& pre_grasp,
                           const SearchSettings& settings, std::uint64_t seed, const Accept& accept = {},
                           const SearchProgress& progress = {});

/// The same for one search.
SearchResult search_grasps(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object,
                           const SynergyGroup& group, const SynergyBox& pre_grasp, const SearchSettings& settings,
                           std::uint64_t seed, const Accept& accept = {}, const SearchProgress& progress = {});

}  // namespace opponens::grasp
