// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "motion/plan_diagnostics.hpp"
#include "motion/syn_planner.hpp"

namespace opponens::motion {

/// Throws std::invalid_argument naming what is wrong with the arguments of plan().
void validate(const PlanQuery& query, const World& world, const PlannerSettings& settings);

/// One run of Algorithm 2: what plan() keeps during a search. Arguments are referred to and must be valid.
class PlanRun {
 public:
  PlanRun(const PlanQuery& query, const World& world, const PlannerSettings& settings, std::uint64_t seed);
  PlanAnswer planner();
  /// As the search left them.
  const Graph& start_graph() const { return start_graph_; }
  const Graph& goal_graph() const { return goal_graph_; }
  /// Where the graphs met; nullopt unless solved. vertex_a is of the start's graph.
  const std::optional<Bridge>& bridge() const { return bridge_; }

 private:
  // plan_run.cpp: the loop.
  std::optional<PlanStatus> end_condition();
  Eigen::VectorXd random_configuration();
  bool follows_boxes() const;
  Extension extend(Graph& graph, const Eigen::VectorXd& q_rand);
  std::optional<Bridge> connect(int vertex_new, Graph& a, Graph& b);
  bool confirmed(const std::vector<int>& path, Graph& graph);
  bool confirmed(const Bridge& bridge);
  void fill_path(const Bridge& bridge);

  // plan_roots.cpp: the roots, and what became of them.
  bool plant_start();
  void plant_goals();
  PlanAnswer without_goals();
  PlanAnswer finished(PlanStatus status, std::string detail = "");
  PlanDiagnostics diagnose() const;
  void count_pairs(PlanDiagnostics& diagnostics) const;

  const PlanQuery& query_;
  const World& world_;
  const PlannerSettings& settings_;
  StepSettings steps_;
  Rng rng_;
  JointInterval sampled_;  ///< of most targets
  Graph start_graph_;
  Graph goal_graph_;
  std::vector<std::size_t> waiting_;       ///< goals of the query that are not judged yet, the next to join last
  std::vector<GoalFate> fates_;            ///< of the query's goals
  std::vector<std::size_t> goal_of_root_;  ///< index into the query's goals
  SearchCounts counts_;
  std::int64_t unconfirmed_ = 0;
  int gap_goal_ = -1;
  std::optional<Bridge> bridge_;
  PlanAnswer result_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace opponens::motion
