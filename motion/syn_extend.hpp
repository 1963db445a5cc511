// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "core/synergies.hpp"
#include "motion/joint_groups.hpp"
#include "motion/sample_forest.hpp"
#include "motion/search_counts.hpp"
#include "motion/world.hpp"

namespace opponens::motion {

/// PROJECT of Algorithm 3 for the tree of one root: the configuration near q_target that follows the root's synergies.
/// [d] rad in and out, inside the joint limits when q_target is; deterministic. Empty: the identity.
using Projection = std::function<Eigen::VectorXd(const Eigen::VectorXd& q_target)>;

/// The paper's PROJECT: the arm part of q_target is kept, the hand part is projected onto the box and clipped to the
/// limits, since a box may stick out of them (docs/deviations.md, 13). lower, upper: [d] rad; hand: index range in q.
Projection box_projection(const SynergyBox& box, const PlanningGroup& hand, const Eigen::VectorXd& lower,
                          const Eigen::VectorXd& upper);

/// One of the two graphs of Algorithm 2, with PROJECT of each of its roots.
struct Graph {
  SampleForest forest;
  std::vector<Projection> projections;  ///< [forest.root_count()]
};

struct StepSettings {
  double step = 0.4;           ///< rad, epsilon
  double minimum_step = 1e-9;  ///< rad, shorter steps towards a projection are not made
  /// A step is also short enough that none of these groups moves more than its own epsilon.
  std::vector<GroupLimit> groups{};
  double shortest() const;  ///< rad, the least epsilon
};

enum class Advance {
  blocked,   ///< the empty set: the step collides
  stalled,   ///< the empty set: the projection of the target is where the tree is already
  advanced,  ///< a step towards the target
  reached,   ///< the target itself
};

struct Extension {
  Advance advance = Advance::blocked;
  int vertex = -1;   ///< q_new in the graph's forest; q_near's index when nothing was added
  double gap = 0.0;  ///< rad, |q_target - q_near| before the step
  bool grew() const { return advance == Advance::advanced || advance == Advance::reached; }
};

/// Algorithm 3, SYNEXTEND: one step of at most epsilon from the vertex nearest to q_target, towards its projection onto
/// the synergy box of that vertex's root, or to q_target itself when that is within epsilon (and each group's). Two
/// differences from the print (docs/deviations.md): a projected step shorter than minimum_step is the empty set (line 5
/// would divide by zero), and along_synergies = false makes PROJECT the identity (full-space targets, the fallback of
/// SYNCONNECT, the baseline).
Extension syn_extend(Graph& graph, const Eigen::VectorXd& q_target, bool along_synergies, const StepSettings& settings,
                     const World& world, SearchCounts& counts);

}  // namespace opponens::motion
