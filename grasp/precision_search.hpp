// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/grasp.hpp"
#include "core/rng.hpp"
#include "core/synergies.hpp"
#include "grasp/distinct_grasps.hpp"
#include "grasp/grasp_check.hpp"
#include "grasp/grasp_search.hpp"
#include "grasp/precision_problem.hpp"
#include "grasp/precision_solver.hpp"
#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::grasp {

struct PrecisionSettings {
  int count = 5;              ///< grasps to return
  int max_trials = 200;       ///< seeds tried; the search stops on counts, never on a clock
  int enough = 10;            ///< stop when this many trials gave a grasp; at least count
  int draws = 48;             ///< seeds drawn per trial; the best is optimised
  int max_evaluations = 120;  ///< of the problem per trial, by the optimiser
  PrecisionGoal goal = PrecisionGoal::min_weight;
  PrecisionSolver solver = PrecisionSolver::slsqp;
  TipModel tips = TipModel::ball;
  double mu = 0.5;                              ///< friction coefficient, of the convention below
  std::optional<QualityConvention> convention;  ///< default: 8 edges, normal force 1, torque / rho of the object
  double max_penetration = 0.001;               ///< m, of a tip's link into the object; other links stay 0.5 mm away
  double clearance_pregrasp = 0.01;             ///< m
  GraspDistances distances;                     ///< of returned grasps from each other
  int threads = 1;
};
void validate(const PrecisionSettings& settings);  ///< throws std::invalid_argument naming field, value, constraint

/// What a trial reads beside the space; refers to the caller's values.
struct PrecisionSearch {
  const PrecisionSpace& space;
  const PrecisionSettings& settings;
  const HandCheckers& checkers;
  const std::string& group;
  const SynergyBox* pre_grasp = nullptr;  ///< null: no pre-grasp is looked for, its fields stay empty
  Accept accept = {};                     ///< an extra test, as of search_grasps; needs a pre-grasp
  SearchProgress progress = {};
};

struct PrecisionTrial {
  std::optional<Grasp> grasp;
  std::string reason;  ///< when there is no grasp
  std::int64_t evaluations = 0;
};

/// One grasp with the finger tips: a pinching seed (tip_seed.hpp), the nonlinear programme (precision_problem.hpp), the
/// tips closed to the exact distance within 0.02 mm, then what every grasp is held to (posture_fault, quality). The
/// posture is inside the box: the slack is zero. p_OC: nearest point of the object's surface, n_O: against the gradient
/// of the exact distance at the tip, which on an edge is the direction in which a ball touches it.
PrecisionTrial precision_trial(const PrecisionSearch& search, Rng& rng);

/// Trials with streams "precision/<group>/<index>" until `enough` of them gave a grasp or max_trials are done; the best
/// `count` different ones by the goal. Deterministic for a seed whatever the thread count. hand: rooted at the palm
/// (load_hand). An object that no hand shape spans gives no grasp, and its reasons.
SearchResult search_precision_grasps(const robot::RobotModel& hand, const robot::Scene& scene,
                                     const std::string& object, const SynergyGroup& group, const SynergyBox* pre_grasp,
                                     const PrecisionSettings& settings, std::uint64_t seed);

/// The same in a world made by the caller, with an extra test.
SearchResult search_precision_grasps(const SearchWorld& world, const SynergyGroup& group, const SynergyBox* pre_grasp,
                                     const PrecisionSettings& settings, std::uint64_t seed, const Accept& accept = {},
                                     const SearchProgress& progress = {});

/// The same with everything made by the caller, for many searches of one object.
SearchResult search_precision_grasps(const PrecisionSearch& search, std::uint64_t seed);

}  // namespace opponens::grasp
