// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/syn_extend.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {

Projection box_projection(const SynergyBox& box, const PlanningGroup& hand, const Eigen::VectorXd& lower,
                          const Eigen::VectorXd& upper) {
  require(box.center.size() == hand.count, "box_projection: the box has " + std::to_string(box.center.size()) +
                                               " joints, the hand " + std::to_string(hand.count));
  require(hand.first >= 0 && hand.first + hand.count <= lower.size() && lower.size() == upper.size(),
          "box_projection: the hand's index range exceeds the configuration");
  const Eigen::VectorXd hand_lower = lower.segment(hand.first, hand.count);
  const Eigen::VectorXd hand_upper = upper.segment(hand.first, hand.count);
  return [=](const Eigen::VectorXd& q_target) {
    Eigen::VectorXd q_proj = q_target;
    q_proj.segment(hand.first, hand.count) =
        analysis::project(box, q_target.segment(hand.first, hand.count)).cwiseMax(hand_lower).cwiseMin(hand_upper);
    return q_proj;
  };
}

double StepSettings::shortest() const {
  double least = step;
  for (const GroupLimit& group : groups) least = std::min(least, group.limit);
  return least;
}

Extension syn_extend(Graph& graph, const Eigen::VectorXd& q_target, bool along_synergies, const StepSettings& settings,
                     const World& world, SearchCounts& counts) {
  ++counts.extends;
  SampleForest& forest = graph.forest;
  const SampleForest::Nearest near = forest.nearest(q_target);  // line 1
  const Eigen::VectorXd q_near = forest.vertex(near.vertex);
  Extension extension{Advance::advanced, near.vertex, near.distance};
  const auto share = [&](const Eigen::VectorXd& q) {
    return largest_share(forest.weights(), q_near, q, settings.groups);
  };
  Eigen::VectorXd q_new;
  if (near.distance <= settings.step && share(q_target) <= 1.0) {  // line 2
    extension.advance = Advance::reached;
    if (near.distance == 0.0) return extension;  // the target is a vertex already
    q_new = q_target;
  } else {
    const Projection& project = graph.projections[static_cast<std::size_t>(forest.root(near.vertex))];
    q_new = along_synergies && project ? project(q_target) : q_target;  // line 4: q_proj
    const double length = distance(forest.weights(), q_near, q_new);
    if (length < settings.minimum_step) return {Advance::stalled, near.vertex, near.distance};
    const double part = std::min(settings.step / length, 1.0 / share(q_new));  // infinite without groups
    if (part < 1.0) q_new = q_near + part * (q_new - q_near);                  // line 5
  }
  if (const auto fraction = world.first_invalid(q_near, q_new, counts.collision_checks)) {  // line 6
    counts.blocked.add(q_near, q_new, *fraction);
    return {Advance::blocked, near.vertex, near.distance};  // line 9
  }
  extension.vertex = forest.add(q_new, near.vertex);  // line 7
  ++counts.extends_grown;
  return extension;  // line 8
}

}  // namespace opponens::motion
