// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "core/synergies.hpp"
#include "motion/plan_diagnostics.hpp"
#include "motion/syn_extend.hpp"
#include "motion/world.hpp"

namespace opponens::motion {

/// A goal configuration with the synergy box of its grasp's group: the root of one tree of the goal graph.
struct GoalRoot {
  Eigen::VectorXd q;          ///< [d] rad
  SynergyBox box;             ///< hand part of the group's synergies
  int goal = 0;               ///< index reported when this root is reached
  std::int64_t joins_at = 0;  ///< as Root::joins_at
};

enum class Variant {
  synergy,           ///< Algorithms 2-4 (the paper's case b)
  rrtconnect,        ///< the multi-goal RRT-Connect baseline (case a): no PROJECT, no SYNCONNECT, no fallback
  synergy_sampling,  ///< ablation: targets projected onto the box of the tree nearest to them; steps and CONNECT
                     ///< straight
  pregrasp_box,  ///< ablation: Algorithms 2-4 with the start's box alone; PROJECT of the goals' trees is the identity
};

/// In the order of the enumerators.
inline constexpr std::array<std::string_view, 4> kVariantNames{"synergy", "rrtconnect", "synergy_sampling",
                                                               "pregrasp_box"};

/// nullopt when no variant is called that.
std::optional<Variant> variant_named(std::string_view name);

/// Where a search stands.
struct PlanProgress {
  std::int64_t iterations = 0;
  std::int64_t collision_checks = 0;
  std::int64_t vertices = 0;  ///< of both graphs
};

struct PlannerSettings {
  Variant variant = Variant::synergy;
  double step = 0.4;                     ///< rad, epsilon of Algorithm 3 in the weighted metric
  double full_space_probability = 0.05;  ///< share of targets not projected (docs/deviations.md, 12)
  /// rad. A joint whose limits are further apart is sampled within an interval of this length around its values at
  /// start and goals, except for full_space_probability of the targets (docs/deviations.md, 36). Infinite: within the
  /// limits.
  double sampled_range = 2.0 * std::numbers::pi;
  double minimum_step = 1e-9;            ///< rad, SYNEXTEND returns nothing below it
  std::int64_t max_iterations = 100000;  ///< passes of Algorithm 2's loop
  std::int64_t max_checks = 0;           ///< 0: unlimited; asked once per iteration, so one iteration may pass it
  double time_limit = 0.0;               ///< s of wall clock; 0: none (searches stop on counts)
  /// Epsilons of joint groups: a step is also short enough that no group moves more than its own.
  std::vector<GroupLimit> group_steps{};
  bool diagnose = false;                              ///< give diagnostics of a success too
  std::function<bool()> interrupted;                  ///< polled once per iteration; empty: never
  std::function<void(const PlanProgress&)> progress;  ///< told before each iteration; empty: nobody
};
/// Throws std::invalid_argument naming field, value and violated constraint.
void validate(const PlannerSettings& settings);

/// A root of Algorithm 2's graphs with its own PROJECT.
struct Root {
  Eigen::VectorXd q;   ///< [d] rad
  Projection project;  ///< empty: the identity
  int goal = -1;       ///< index reported when this root is reached; not used for the start
  /// Passes of the loop that are made before this goal is rooted: 0 for one that is known from the beginning, more for
  /// one found meanwhile. It is asked for freedom from collision then. Not used for the start.
  std::int64_t joins_at = 0;
};

/// One query with projections instead of boxes. lower, upper, weights: [d].
struct PlanQuery {
  Root start;
  std::vector<Root> goals;
  std::vector<std::string> joint_names;  ///< [d]
  Eigen::VectorXd lower;                 ///< rad, finite
  Eigen::VectorXd upper;                 ///< rad, finite, >= lower
  Eigen::VectorXd weights;               ///< of the joint metric, positive
};

struct JointInterval {
  Eigen::VectorXd lower;  ///< [d] rad
  Eigen::VectorXd upper;  ///< [d] rad
};
/// The part of the limits that most targets are drawn from: a joint that can turn more than once reaches every posture
/// within one turn, so the rest of its range holds copies of what is nearer. Where the limits are more than range
/// apart, the interval is that long (or holds start and goals, when these are further apart), with start and goals in
/// its middle as far as the limits leave room. Goals that join
/// later do not count.
JointInterval sampled_part(const PlanQuery& query, double range);

/// Algorithm 2, PLANNER, with every valid goal rooted from the beginning, or when it joins. Targets are drawn uniformly
/// within the limits from a stream of its own: same query, world, settings and seed, same path, byte for byte (unless
/// time_limit or interrupted end it). When World::confirm is given, it is asked of each motion of the path found; a
/// motion that fails is deleted from its graph with everything grown from it, and the search goes on
/// (docs/deviations.md, 14). Goals outside the limits or in collision are left out and counted; while no goal has
/// joined yet, the start's tree grows alone. A failure comes with diagnostics, for which World::explain is asked at
/// most 97 times after the search.
PlanAnswer plan(const PlanQuery& query, const World& world, const PlannerSettings& settings, std::uint64_t seed);

/// The same for the paper's query: the start tree follows the pre-grasp box, every goal tree its group's box. hand:
/// index range of the hand in q. docs/algorithms/planner.md.
PlanAnswer plan(const Eigen::VectorXd& start, const SynergyBox& pre_grasp, const std::vector<GoalRoot>& goals,
                const std::vector<std::string>& joint_names, const PlanningGroup& hand, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const Eigen::VectorXd& weights, const World& world,
                const PlannerSettings& settings, std::uint64_t seed);

/// A configuration that both graphs hold: V_a and V_b meet here.
struct Bridge {
  int vertex_a;
  int vertex_b;
};

/// Algorithm 4, SYNCONNECT: q_new, just added to graph a, draws an extension of b, that one an extension of a, and so
/// on until the graphs meet or an extension collides. As printed it need not end (docs/deviations.md), so: when the gap
/// has not shrunk by a hundredth of epsilon during two extensions of each graph, or a step is below minimum_step, one
/// last attempt is made by straight full-space steps towards the newest configuration. Hence at most 4 + 400 gap /
/// epsilon extensions, and as many straight steps as the gap is long.
std::optional<Bridge> syn_connect(int vertex_new, Graph& a, Graph& b, const StepSettings& settings, const World& world,
                                  SearchCounts& counts);

/// CONNECT of RRT-Connect (Kuffner and LaValle 2000, doi:10.1109/ROBOT.2000.844730): b is extended straight towards a
/// vertex of a until it gets there or collides.
std::optional<Bridge> straight_connect(int vertex_new, const Graph& a, Graph& b, const StepSettings& settings,
                                       const World& world, SearchCounts& counts);

}  // namespace opponens::motion
