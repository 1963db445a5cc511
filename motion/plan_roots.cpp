// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "motion/plan_run.hpp"

namespace opponens::motion {
namespace {

constexpr std::size_t kMostGoalsExplained = 32;

std::vector<LimitExcess> outside_limits(const PlanQuery& query, const Eigen::VectorXd& q) {
  constexpr double kTolerance = 1e-9;  // rad
  std::vector<LimitExcess> outside;
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const double above = q[j] - query.upper[j];
    const double below = q[j] - query.lower[j];
    if (above > kTolerance) outside.push_back({query.joint_names[static_cast<std::size_t>(j)], above});
    if (below < -kTolerance) outside.push_back({query.joint_names[static_cast<std::size_t>(j)], below});
  }
  return outside;
}

}  // namespace

bool PlanRun::plant_start() {
  const auto refused = [&](PlanStatus status, std::string detail) {
    result_.status = status;
    result_.detail = std::move(detail);
    return false;
  };
  const Eigen::VectorXd& q = query_.start.q;
  if (!outside_limits(query_, q).empty()) {
    return refused(PlanStatus::start_out_of_limits, "the start configuration is outside the joint limits");
  }
  if (!world_.free(q.transpose(), counts_.collision_checks).front()) {
    return refused(PlanStatus::start_in_collision, "the start configuration is in collision");
  }
  start_graph_.forest.add_root(q);
  start_graph_.projections.push_back(query_.start.project);
  return true;
}

/// Roots the goals that join now, where they are inside the limits and free: one question for all, which a world may
/// answer in parallel.
void PlanRun::plant_goals() {
  if (waiting_.empty() || query_.goals[waiting_.back()].joins_at > result_.iterations) return;
  std::vector<std::size_t> inside;
  while (!waiting_.empty() && query_.goals[waiting_.back()].joins_at <= result_.iterations) {
    const std::size_t goal = waiting_.back();
    waiting_.pop_back();
    fates_[goal] = outside_limits(query_, query_.goals[goal].q).empty() ? GoalFate::rooted : GoalFate::outside_limits;
    if (fates_[goal] == GoalFate::rooted) {
      inside.push_back(goal);
    } else {
      ++result_.goals_refused;
    }
  }
  if (inside.empty()) return;
  Eigen::MatrixXd batch(static_cast<Eigen::Index>(inside.size()), query_.lower.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    batch.row(static_cast<Eigen::Index>(i)) = query_.goals[inside[i]].q.transpose();
  }
  const std::vector<bool> free = world_.free(batch, counts_.collision_checks);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!free[i]) {
      fates_[inside[i]] = GoalFate::in_collision;
      ++result_.goals_refused;
      continue;
    }
    const Root& goal = query_.goals[inside[i]];
    goal_graph_.forest.add_root(goal.q);
    const bool plain = settings_.variant == Variant::pregrasp_box;
    goal_graph_.projections.push_back(plain ? Projection() : goal.project);
    goal_of_root_.push_back(inside[i]);
  }
}

PlanAnswer PlanRun::without_goals() {
  if (fates_.empty()) return finished(PlanStatus::no_goals, "no goal was given");
  const auto outside = std::count(fates_.begin(), fates_.end(), GoalFate::outside_limits);
  const auto colliding = std::count(fates_.begin(), fates_.end(), GoalFate::in_collision);
  return finished(PlanStatus::no_goals, "of " + std::to_string(fates_.size()) + " goals, " + std::to_string(outside) +
                                            " are outside the joint limits and " + std::to_string(colliding) +
                                            " in collision");
}

PlanAnswer PlanRun::finished(PlanStatus status, std::string detail) {
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
  if (status != PlanStatus::solved || settings_.diagnose) result_.diagnostics = diagnose();
  return std::move(result_);
}

PlanDiagnostics PlanRun::diagnose() const {
  PlanDiagnostics diagnostics;
  diagnostics.start_outside = outside_limits(query_, query_.start.q);
  if (result_.status == PlanStatus::start_in_collision && world_.explain) {
    diagnostics.start_pairs = world_.explain(query_.start.q);
  }
  diagnostics.start_vertices = start_graph_.forest.size();
  std::size_t explained = 0;
  for (std::size_t i = 0; i < fates_.size(); ++i) {
    const Root& goal = query_.goals[i];
    GoalDiagnosis diagnosis{goal.goal, fates_[i], {}, {}, 0};
    if (fates_[i] == GoalFate::outside_limits) diagnosis.outside = outside_limits(query_, goal.q);
    if (fates_[i] == GoalFate::in_collision && world_.explain && explained++ < kMostGoalsExplained) {
      diagnosis.pairs = world_.explain(goal.q);
    }
    diagnostics.goals.push_back(std::move(diagnosis));
  }
  const SampleForest& forest = goal_graph_.forest;
  for (int vertex = 0; vertex < forest.size(); ++vertex) {
    ++diagnostics.goals[goal_of_root_[static_cast<std::size_t>(forest.root(vertex))]].vertices;
  }
  diagnostics.unconfirmed = unconfirmed_;
  diagnostics.gap = counts_.closest.gap;
  diagnostics.gap_goal = gap_goal_;
  count_pairs(diagnostics);
  return diagnostics;
}

void PlanRun::count_pairs(PlanDiagnostics& diagnostics) const {
  diagnostics.blocked = counts_.blocked.seen();
  if (!world_.explain) return;
  std::map<NamePair, std::int64_t> counts;
  for (const Eigen::VectorXd& q : counts_.blocked.kept()) {
    for (NamePair& pair : world_.explain(q)) ++counts[std::move(pair)];
    ++diagnostics.explained;
  }
  for (const auto& [pair, count] : counts) diagnostics.pairs.push_back({pair, count});
  std::stable_sort(diagnostics.pairs.begin(), diagnostics.pairs.end(),
                   [](const PairCount& a, const PairCount& b) { return a.count > b.count; });
}

}  // namespace opponens::motion
