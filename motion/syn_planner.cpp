// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/syn_planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {
namespace {

void validate(const PlanQuery& query) {
  const Eigen::Index d = query.lower.size();
  require(d > 0 && query.upper.size() == d && query.weights.size() == d &&
              query.joint_names.size() == static_cast<std::size_t>(d),
          "plan: lower, upper, weights and joint_names must have one entry per joint");
  require(query.lower.allFinite() && query.upper.allFinite() && (query.lower.array() <= query.upper.array()).all(),
          "plan: limits must be finite with lower <= upper");
  require(query.start.q.size() == d && query.start.q.allFinite(), "plan: start must have d finite entries");
  for (const Root& goal : query.goals) {
    require(goal.q.size() == d && goal.q.allFinite(), "plan: every goal must have d finite entries");
  }
}

bool within_limits(const PlanQuery& query, const Eigen::VectorXd& q) {
  constexpr double kTolerance = 1e-9;  // rad
  return (q.array() >= query.lower.array() - kTolerance).all() && (q.array() <= query.upper.array() + kTolerance).all();
}

bool is_free(const World& world, const Eigen::VectorXd& q, SearchCounts& counts) {
  return world.free(q.transpose(), counts.collision_checks).front();
}

/// One run of Algorithm 2.
class Run {
 public:
  Run(const PlanQuery& query, const World& world, const PlannerSettings& settings, std::uint64_t seed)
      : query_(query),
        world_(world),
        settings_(settings),
        steps_{settings.step, settings.minimum_step},
        rng_(stream(seed, "motion/plan")),
        start_graph_{SampleForest(query.weights), {}},
        goal_graph_{SampleForest(query.weights), {}} {}

  PlanResult planner();

 private:
  std::optional<PlanStatus> end_condition();
  Eigen::VectorXd random_configuration();
  bool plant_roots();
  void plant_goals();
  std::optional<Bridge> connect(int vertex_new, Graph& a, Graph& b);
  bool confirmed(const std::vector<int>& path, Graph& graph);
  bool confirmed(const Bridge& bridge);
  void fill_path(const Bridge& bridge);
  PlanResult finished(PlanStatus status, std::string detail = "");

  const PlanQuery& query_;
  const World& world_;
  const PlannerSettings& settings_;
  StepSettings steps_;
  Rng rng_;
  Graph start_graph_;
  Graph goal_graph_;
  std::vector<int> goal_of_root_;
  SearchCounts counts_;
  PlanResult result_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

/// The main loop of Algorithm 2.
PlanResult Run::planner() {
  if (!plant_roots()) return finished(result_.status, result_.detail);  // lines 1-3
  Graph* a = &start_graph_;
  Graph* b = &goal_graph_;
  while (true) {
    if (const auto status = end_condition()) return finished(*status);  // line 4
    ++result_.iterations;
    const Eigen::VectorXd q_rand = random_configuration();  // line 5
    const bool along_synergies =
        rng_.uniform() >= settings_.full_space_probability && settings_.variant == Variant::synergy;
    const Extension q_new = syn_extend(*a, q_rand, along_synergies, steps_, world_, counts_);  // line 6
    const auto found = q_new.grew() ? connect(q_new.vertex, *a, *b) : std::nullopt;            // line 7
    if (found) {
      const Bridge bridge = a == &start_graph_ ? *found : Bridge{found->vertex_b, found->vertex_a};
      if (confirmed(bridge)) {
        fill_path(bridge);
        return finished(PlanStatus::solved);  // line 8
      }
    }
    std::swap(a, b);  // line 10
  }
}

std::optional<Bridge> Run::connect(int vertex_new, Graph& a, Graph& b) {
  return settings_.variant == Variant::synergy ? syn_connect(vertex_new, a, b, steps_, world_, counts_)
                                               : straight_connect(vertex_new, a, b, steps_, world_, counts_);
}

std::optional<PlanStatus> Run::end_condition() {
  if (settings_.interrupted && settings_.interrupted()) return PlanStatus::interrupted;
  if (result_.iterations >= settings_.max_iterations) return PlanStatus::iteration_limit;
  if (settings_.max_checks > 0 && counts_.collision_checks >= settings_.max_checks) return PlanStatus::check_limit;
  if (settings_.time_limit > 0.0) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
    if (spent.count() >= settings_.time_limit) return PlanStatus::time_limit;
  }
  return std::nullopt;
}

Eigen::VectorXd Run::random_configuration() {
  Eigen::VectorXd q(query_.lower.size());
  for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng_.uniform(query_.lower[j], query_.upper[j]);
  return q;
}

bool Run::plant_roots() {
  const auto refused = [&](PlanStatus status, std::string detail) {
    result_.status = status;
    result_.detail = std::move(detail);
    return false;
  };
  if (!within_limits(query_, query_.start.q)) {
    return refused(PlanStatus::start_out_of_limits, "the start configuration is outside the joint limits");
  }
  if (!is_free(world_, query_.start.q, counts_)) {
    return refused(PlanStatus::start_in_collision, "the start configuration is in collision");
  }
  start_graph_.forest.add_root(query_.start.q);
  start_graph_.projections.push_back(query_.start.project);
  plant_goals();
  if (!goal_of_root_.empty()) return true;
  const auto inside = std::count_if(query_.goals.begin(), query_.goals.end(),
                                    [&](const Root& goal) { return within_limits(query_, goal.q); });
  const std::size_t count = query_.goals.size();
  return refused(PlanStatus::no_goals, count == 0 ? "no goal was given"
                                                  : "of " + std::to_string(count) + " goals, " +
                                                        std::to_string(count - static_cast<std::size_t>(inside)) +
                                                        " are outside the joint limits and " + std::to_string(inside) +
                                                        " in collision");
}

/// Roots every goal that is inside the limits and free: one question for all, which a world may answer in parallel.
void Run::plant_goals() {
  std::vector<const Root*> inside;
  for (const Root& goal : query_.goals) {
    if (within_limits(query_, goal.q)) inside.push_back(&goal);
  }
  Eigen::MatrixXd batch(static_cast<Eigen::Index>(inside.size()), query_.lower.size());
  for (std::size_t i = 0; i < inside.size(); ++i) batch.row(static_cast<Eigen::Index>(i)) = inside[i]->q.transpose();
  const std::vector<bool> free = inside.empty() ? std::vector<bool>() : world_.free(batch, counts_.collision_checks);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!free[i]) continue;
    goal_graph_.forest.add_root(inside[i]->q);
    goal_graph_.projections.push_back(inside[i]->project);
    goal_of_root_.push_back(inside[i]->goal);
  }
}

/// Whether the stricter question is answered well for the motions to these vertices; removes what hangs on one that is
/// not.
bool Run::confirmed(const std::vector<int>& path, Graph& graph) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::VectorXd q_from = graph.forest.vertex(path[i - 1]);
    if (world_.confirm(q_from, graph.forest.vertex(path[i]), counts_.collision_checks)) {
      graph.forest.remove_subtree(path[i]);
      return false;
    }
  }
  return true;
}

bool Run::confirmed(const Bridge& bridge) {
  if (!world_.confirm) return true;
  const bool start_side = confirmed(start_graph_.forest.path_from_root(bridge.vertex_a), start_graph_);
  const bool goal_side = confirmed(goal_graph_.forest.path_from_root(bridge.vertex_b), goal_graph_);
  return start_side && goal_side;
}

/// PATH of line 8: from the start's root to the bridge, and on to the goal's root.
void Run::fill_path(const Bridge& bridge) {
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
  result_.goal = goal_of_root_[static_cast<std::size_t>(goal_graph_.forest.root(bridge.vertex_b))];
  result_.length = path_length(query_.weights, result_.path.waypoints);
  result_.length_l1 = path_length_l1(query_.weights, result_.path.waypoints);
}

PlanResult Run::finished(PlanStatus status, std::string detail) {
  result_.status = status;
  result_.extends = counts_.extends;
  result_.extends_grown = counts_.extends_grown;
  result_.collision_checks = counts_.collision_checks;
  result_.detail = std::move(detail);
  if (status != PlanStatus::solved && result_.detail.empty()) {
    result_.detail = "stopped after " + std::to_string(result_.iterations) + " iterations and " +
                     std::to_string(result_.collision_checks) + " collision checks; " +
                     std::to_string(start_graph_.forest.size()) + " vertices from the start, " +
                     std::to_string(goal_graph_.forest.size()) + " from " + std::to_string(goal_of_root_.size()) +
                     " goals";
  }
  return std::move(result_);
}

}  // namespace

void validate(const PlannerSettings& settings) {
  const auto check = [](bool holds, const std::string& field, double value, const std::string& constraint) {
    require(holds,
            [&] { return "PlannerSettings::" + field + " = " + std::to_string(value) + ": must be " + constraint; });
  };
  check(std::isfinite(settings.step) && settings.step > 0.0, "step", settings.step, "positive and finite (rad)");
  check(settings.full_space_probability >= 0.0 && settings.full_space_probability <= 1.0, "full_space_probability",
        settings.full_space_probability, "in [0, 1]");
  check(settings.minimum_step > 0.0 && settings.minimum_step < settings.step, "minimum_step", settings.minimum_step,
        "positive and below step");
  check(settings.max_iterations >= 0, "max_iterations", static_cast<double>(settings.max_iterations), ">= 0");
  check(settings.max_checks >= 0, "max_checks", static_cast<double>(settings.max_checks), ">= 0 (0: unlimited)");
  check(std::isfinite(settings.time_limit) && settings.time_limit >= 0.0, "time_limit", settings.time_limit,
        ">= 0 and finite (s; 0: none)");
}

PlanResult plan(const PlanQuery& query, const World& world, const PlannerSettings& settings, std::uint64_t seed) {
  validate(settings);
  validate(query);
  require(world.first_invalid && world.free, "plan: World::first_invalid and World::free must be given");
  return Run(query, world, settings, seed).planner();
}

PlanResult plan(const Eigen::VectorXd& start, const SynergyBox& pre_grasp, const std::vector<GoalRoot>& goals,
                const std::vector<std::string>& joint_names, const PlanningGroup& hand, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const Eigen::VectorXd& weights, const World& world,
                const PlannerSettings& settings, std::uint64_t seed) {
  PlanQuery query{{start, box_projection(pre_grasp, hand, lower, upper), -1}, {}, joint_names, lower, upper, weights};
  for (const GoalRoot& goal : goals) {
    query.goals.push_back({goal.q, box_projection(goal.box, hand, lower, upper), goal.goal});
  }
  return plan(query, world, settings, seed);
}

}  // namespace opponens::motion
