// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/syn_planner.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/require.hpp"
#include "motion/plan_run.hpp"

namespace opponens::motion {
namespace {

void validate_query(const PlanQuery& query) {
  const Eigen::Index d = query.lower.size();
  require(d > 0 && query.upper.size() == d && query.weights.size() == d &&
              query.joint_names.size() == static_cast<std::size_t>(d),
          "plan: lower, upper, weights and joint_names must have one entry per joint");
  require(query.lower.allFinite() && query.upper.allFinite() && (query.lower.array() <= query.upper.array()).all(),
          "plan: limits must be finite with lower <= upper");
  require(query.start.q.size() == d && query.start.q.allFinite(), "plan: start must have d finite entries");
  for (const Root& goal : query.goals) {
    require(goal.q.size() == d && goal.q.allFinite(), "plan: every goal must have d finite entries");
    require(goal.joins_at >= 0, "plan: Root::joins_at must be >= 0");
  }
}

}  // namespace

std::optional<Variant> variant_named(std::string_view name) {
  const auto found = std::find(kVariantNames.begin(), kVariantNames.end(), name);
  if (found == kVariantNames.end()) return std::nullopt;
  return static_cast<Variant>(found - kVariantNames.begin());
}

JointInterval sampled_part(const PlanQuery& query, double range) {
  JointInterval part{query.lower, query.upper};
  for (Eigen::Index j = 0; j < query.lower.size(); ++j) {
    double least = query.start.q[j];
    double most = least;
    for (const Root& goal : query.goals) {
      if (goal.joins_at > 0) continue;
      least = std::min(least, goal.q[j]);
      most = std::max(most, goal.q[j]);
    }
    const double length = std::max(range, most - least);
    if (!(query.upper[j] - query.lower[j] > length)) continue;
    part.lower[j] = std::clamp(0.5 * (least + most - length), query.lower[j], query.upper[j] - length);
    part.upper[j] = part.lower[j] + length;
  }
  return part;
}

void validate(const PlannerSettings& settings) {
  const auto check = [](bool holds, const std::string& field, double value, const std::string& constraint) {
    require(holds,
            [&] { return "PlannerSettings::" + field + " = " + std::to_string(value) + ": must be " + constraint; });
  };
  check(std::isfinite(settings.step) && settings.step > 0.0, "step", settings.step, "positive and finite (rad)");
  check(settings.sampled_range > 0.0, "sampled_range", settings.sampled_range, "positive (rad; infinite: the limits)");
  check(settings.full_space_probability >= 0.0 && settings.full_space_probability <= 1.0, "full_space_probability",
        settings.full_space_probability, "in [0, 1]");
  check(settings.minimum_step > 0.0 && settings.minimum_step < settings.step, "minimum_step", settings.minimum_step,
        "positive and below step");
  check(settings.max_iterations >= 0, "max_iterations", static_cast<double>(settings.max_iterations), ">= 0");
  check(settings.max_checks >= 0, "max_checks", static_cast<double>(settings.max_checks), ">= 0 (0: unlimited)");
  check(std::isfinite(settings.time_limit) && settings.time_limit >= 0.0, "time_limit", settings.time_limit,
        ">= 0 and finite (s; 0: none)");
  for (const GroupLimit& group : settings.group_steps) {
    check(std::isfinite(group.limit) && group.limit > settings.minimum_step, "group_steps", group.limit,
          "finite and above minimum_step (rad)");
  }
}

void validate(const PlanQuery& query, const World& world, const PlannerSettings& settings) {
  validate(settings);
  validate_query(query);
  validate(settings.group_steps, query.lower.size(), "PlannerSettings::group_steps");
  require(world.first_invalid && world.free, "plan: World::first_invalid and World::free must be given");
}

PlanAnswer plan(const PlanQuery& query, const World& world, const PlannerSettings& settings, std::uint64_t seed) {
  validate(query, world, settings);
  return PlanRun(query, world, settings, seed).planner();
}

PlanAnswer plan(const Eigen::VectorXd& start, const SynergyBox& pre_grasp, const std::vector<GoalRoot>& goals,
                const std::vector<std::string>& joint_names, const PlanningGroup& hand, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const Eigen::VectorXd& weights, const World& world,
                const PlannerSettings& settings, std::uint64_t seed) {
  PlanQuery query{{start, box_projection(pre_grasp, hand, lower, upper), -1}, {}, joint_names, lower, upper, weights};
  for (const GoalRoot& goal : goals) {
    query.goals.push_back({goal.q, box_projection(goal.box, hand, lower, upper), goal.goal, goal.joins_at});
  }
  return plan(query, world, settings, seed);
}

}  // namespace opponens::motion
