// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/plan_run.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "motion/joint_metric.hpp"

namespace opponens::motion {

PlanRun::PlanRun(const PlanQuery& query, const World& world, const PlannerSettings& settings, std::uint64_t seed)
    : query_(query),
      world_(world),
      settings_(settings),
      steps_{settings.step, settings.minimum_step, settings.group_steps},
      rng_(stream(seed, "motion/plan")),
      sampled_(sampled_part(query, settings.sampled_range)),
      start_graph_{SampleForest(query.weights), {}},
      goal_graph_{SampleForest(query.weights), {}},
      fates_(query.goals.size(), GoalFate::not_joined) {
  for (std::size_t i = query.goals.size(); i-- > 0;) waiting_.push_back(i);
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [&](std::size_t i, std::size_t j) { return query.goals[i].joins_at > query.goals[j].joins_at; });
}

bool PlanRun::follows_boxes() const {
  return settings_.variant == Variant::synergy || settings_.variant == Variant::pregrasp_box;
}

/// The main loop of Algorithm 2.
PlanAnswer PlanRun::planner() {
  if (!plant_start()) return finished(result_.status, result_.detail);  // lines 1-3
  Graph* a = &start_graph_;
  Graph* b = &goal_graph_;
  while (true) {
    plant_goals();
    if (goal_of_root_.empty() && waiting_.empty()) return without_goals();
    if (const auto status = end_condition()) return finished(*status);  // line 4
    ++result_.iterations;
    const Eigen::VectorXd q_rand = random_configuration();  // line 5
    const Extension q_new = extend(*a, q_rand);             // line 6
    if (goal_of_root_.empty()) continue;                    // no goal has joined yet: the start's tree grows alone
    const auto found = q_new.grew() ? connect(q_new.vertex, *a, *b) : std::nullopt;  // line 7
    if (found) {
      const Bridge bridge = a == &start_graph_ ? *found : Bridge{found->vertex_b, found->vertex_a};
      if (confirmed(bridge)) {
        fill_path(bridge);
        bridge_ = bridge;
        return finished(PlanStatus::solved);  // line 8
      }
    }
    std::swap(a, b);  // line 10
  }
}

/// One step towards a random target. Every variant draws the same numbers.
Extension PlanRun::extend(Graph& graph, const Eigen::VectorXd& q_rand) {
  const bool projected = rng_.uniform() >= settings_.full_space_probability;
  if (settings_.variant == Variant::synergy_sampling && projected) {
    const int near = graph.forest.nearest(q_rand).vertex;
    const Projection& project = graph.projections[static_cast<std::size_t>(graph.forest.root(near))];
    return syn_extend(graph, project ? project(q_rand) : q_rand, false, steps_, world_, counts_);
  }
  return syn_extend(graph, q_rand, projected && follows_boxes(), steps_, world_, counts_);
}

std::optional<Bridge> PlanRun::connect(int vertex_new, Graph& a, Graph& b) {
  const double gap = counts_.closest.gap;
  const auto found = follows_boxes() ? syn_connect(vertex_new, a, b, steps_, world_, counts_)
                                     : straight_connect(vertex_new, a, b, steps_, world_, counts_);
  if (counts_.closest.gap < gap) {
    const int root = &a == &goal_graph_ ? counts_.closest.root_a : counts_.closest.root_b;
    gap_goal_ = query_.goals[goal_of_root_[static_cast<std::size_t>(root)]].goal;
  }
  return found;
}

std::optional<PlanStatus> PlanRun::end_condition() {
  if (settings_.progress) {
    settings_.progress({result_.iterations, counts_.collision_checks,
                        std::int64_t{start_graph_.forest.size()} + goal_graph_.forest.size()});
  }
  if (settings_.interrupted && settings_.interrupted()) return PlanStatus::interrupted;
  if (result_.iterations >= settings_.max_iterations) return PlanStatus::iteration_limit;
  if (settings_.max_checks > 0 && counts_.collision_checks >= settings_.max_checks) return PlanStatus::check_limit;
  if (settings_.time_limit > 0.0) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
    if (spent.count() >= settings_.time_limit) return PlanStatus::time_limit;
  }
  return std::nullopt;
}

Eigen::VectorXd PlanRun::random_configuration() {
  const bool narrower = sampled_.lower != query_.lower || sampled_.upper != query_.upper;
  const bool anywhere = !narrower || rng_.uniform() < settings_.full_space_probability;
  const Eigen::VectorXd& lower = anywhere ? query_.lower : sampled_.lower;
  const Eigen::VectorXd& upper = anywhere ? query_.upper : sampled_.upper;
  Eigen::VectorXd q(lower.size());
  for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng_.uniform(lower[j], upper[j]);
  return q;
}

/// Whether the stricter question is answered well for the motions to these vertices; removes what hangs on one that is
/// not.
bool PlanRun::confirmed(const std::vector<int>& path, Graph& graph) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::VectorXd q_from = graph.forest.vertex(path[i - 1]);
    if (world_.confirm(q_from, graph.forest.vertex(path[i]), counts_.collision_checks)) {
      graph.forest.remove_subtree(path[i]);
      return false;
    }
  }
  return true;
}

bool PlanRun::confirmed(const Bridge& bridge) {
  if (!world_.confirm) return true;
  const bool start_side = confirmed(start_graph_.forest.path_from_root(bridge.vertex_a), start_graph_);
  const bool goal_side = confirmed(goal_graph_.forest.path_from_root(bridge.vertex_b), goal_graph_);
  if (start_side && goal_side) return true;
  ++unconfirmed_;
  return false;
}

/// PATH of line 8: from the start's root to the bridge, and on to the goal's root.
void PlanRun::fill_path(const Bridge& bridge) {
  std::vector<Eigen::VectorXd> waypoints;
  for (const int i : start_graph_.forest.path_from_root(bridge.vertex_a)) {
    waypoints.push_back(start_graph_.forest.vertex(i));
  }
  std::vector<int> back = goal_graph_.forest.path_from_root(bridge.vertex_b);
  std::reverse(back.begin(), back.end());
  result_.bridge_row = static_cast<int>(waypoints.size()) - 1;
  // The bridge is a vertex of both graphs: kept once.
  for (std::size_t i = 1; i < back.size(); ++i) waypoints.push_back(goal_graph_.forest.vertex(back[i]));
  result_.path.joint_names = query_.joint_names;
  result_.path.waypoints.resize(static_cast<Eigen::Index>(waypoints.size()), query_.lower.size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    result_.path.waypoints.row(static_cast<Eigen::Index>(i)) = waypoints[i].transpose();
  }
  const auto root = static_cast<std::size_t>(goal_graph_.forest.root(bridge.vertex_b));
  result_.goal = query_.goals[goal_of_root_[root]].goal;
  result_.length = path_length(query_.weights, result_.path.waypoints);
  result_.length_l1 = path_length_l1(query_.weights, result_.path.waypoints);
}

}  // namespace opponens::motion
