// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "experiments/table2_planning/cpu_time.hpp"
#include "motion/edge_check.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::table2 {
namespace {

using motion::Variant;

bool set_planner(const std::string& name, Case& what) {
  if (name == "a") what.variant = Variant::rrtconnect;
  if (name == "b" || name == "c") what.variant = Variant::synergy;
  if (name == "d") what.variant = Variant::synergy_sampling;
  if (name == "e") what.variant = Variant::pregrasp_box;
  if (name == "ompl_rrtconnect") what.ompl = OmplPlanner::rrtconnect;
  if (name == "ompl_lbkpiece1") what.ompl = OmplPlanner::lbkpiece1;
  if (name == "ompl_bitrrt") what.ompl = OmplPlanner::bitrrt;
  what.deranged = name == "c";
  return what.variant || what.ompl;
}

void set_option(const std::string& option, Case& what) {
  const std::size_t sign = option.find('=');
  const std::string key = option.substr(0, sign);
  if (key == "exact" && sign == std::string::npos) {
    what.exact = true;
    return;
  }
  double value = std::numeric_limits<double>::quiet_NaN();
  try {
    if (sign != std::string::npos) value = std::stod(option.substr(sign + 1));
  } catch (const std::exception&) {  // stays no number
  }
  if (!std::isfinite(value)) throw InputError("case " + what.name + ": " + option + ": expected KEY=NUMBER");
  if (key == "full") {
    what.full_space = value;
  } else if (key == "widen") {
    what.widen = value;
  } else if (key == "k") {
    what.synergies = static_cast<int>(value);
  } else {
    throw InputError("case " + what.name + ": unknown option " + key);
  }
}

/// The group whose box each group follows: itself, or a derangement drawn uniformly by rejection.
std::map<std::string, std::string> box_owners(const SynergySet& set, bool deranged, std::uint64_t seed) {
  std::vector<std::size_t> order(set.grasp.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  Rng rng = stream(seed, "table2/derangement");
  const auto fixed = [&] {
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (order[i] == i) return true;
    }
    return false;
  };
  if (deranged) {
    require(order.size() > 1, "case c: one family cannot be mismatched");
    while (fixed()) {
      for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng.index(i)]);
    }
  }
  std::map<std::string, std::string> owners;
  for (std::size_t i = 0; i < order.size(); ++i) owners[set.grasp[i].name] = set.grasp[order[i]].name;
  return owners;
}

SynergyBox box_of(const SynergyGroup& group, const Case& what) {
  SynergyBox box = group.box;
  if (what.synergies) {
    const auto k = std::clamp<Eigen::Index>(*what.synergies, 1, group.basis.axes.cols());
    // The first half width says how many standard deviations the boxes hold.
    const double deviations = box.half_width[0] / std::sqrt(group.basis.variance[0]);
    box.axes = group.basis.axes.leftCols(k);
    box.half_width = deviations * group.basis.variance.head(k).cwiseSqrt();
  }
  box.half_width *= what.widen;
  return box;
}

/// One configuration at a time, by FCL alone: what a planner without our two stages asks.
motion::World exact_world(const Problem& problem) {
  const robot::RobotModel& robot = problem.setting().robot;
  motion::World world = motion::make_world(
      [&](const Eigen::VectorXd& q) { return robot.within_limits(q) && problem.checker().exact_free(q); },
      robot.weights(), problem.setting().resolution);
  world.confirm = problem.world().confirm;
  return world;
}

PlanResult plan_ours(const Case& what, const Problem& problem, const motion::World& world, double range,
                     std::int64_t budget, double& cpu_seconds) {
  const Setting& setting = problem.setting();
  const robot::RobotModel& robot = setting.robot;
  motion::PlannerSettings settings;
  settings.variant = *what.variant;
  settings.step = range;
  settings.full_space_probability = what.full_space;
  settings.max_checks = budget;
  settings.max_iterations = std::numeric_limits<std::int64_t>::max();
  std::vector<motion::GoalRoot> goals = problem.goals();
  const auto owners = box_owners(setting.synergies, what.deranged, problem.seed());
  for (motion::GoalRoot& goal : goals) {
    goal.box = box_of(group_named(setting.synergies, owners.at(problem.grasp_of(goal.goal).group)), what);
  }
  const SynergyBox pre_grasp = box_of(setting.synergies.pre_grasp, what);
  const double begin = thread_cpu_seconds();
  PlanResult planned = motion::plan(setting.start, pre_grasp, goals, robot.joint_names(), robot.hand(), robot.lower(),
                                    robot.upper(), robot.weights(), world, settings, problem.seed());
  cpu_seconds = thread_cpu_seconds() - begin;
  return planned;
}

OmplQuery ompl_query(const Problem& problem) {
  const robot::RobotModel& robot = problem.setting().robot;
  OmplQuery query{problem.setting().start, {}, robot.joint_names(), robot.lower(), robot.upper(), robot.weights()};
  for (const motion::GoalRoot& goal : problem.goals()) query.goals.push_back(goal.q);
  return query;
}

/// CPU of checking each motion of a path at the planner's spacing, the fastest of some goes.
double path_seconds(const Eigen::MatrixXd& waypoints, const motion::World& world) {
  constexpr int kGoes = 5;
  double least = std::numeric_limits<double>::infinity();
  for (int go = 0; go < kGoes; ++go) {
    std::int64_t checks = 0;
    const double begin = thread_cpu_seconds();
    for (Eigen::Index i = 1; i < waypoints.rows(); ++i) {
      world.first_invalid(waypoints.row(i - 1).transpose(), waypoints.row(i).transpose(), checks);
    }
    least = std::min(least, thread_cpu_seconds() - begin);
  }
  return least;
}

void describe_path(const Problem& problem, const motion::World& world, Answer& answer) {
  const Setting& setting = problem.setting();
  const auto& hand = setting.robot.hand();
  const auto& arm = setting.robot.arm();
  const Eigen::MatrixXd& waypoints = answer.path.waypoints;
  const Eigen::MatrixXd q_hand = waypoints.middleCols(hand.first, hand.count);
  const Eigen::MatrixXd q_arm = waypoints.middleCols(arm.first, arm.count);
  Record& record = answer.record;
  record.group = problem.grasp_of(answer.goal).group;
  record.hand_length = motion::path_length(setting.robot.weights().segment(hand.first, hand.count), q_hand);
  record.arm_length = motion::path_length(setting.robot.weights().segment(arm.first, arm.count), q_arm);
  if (setting.free_motion) record.likeness = analysis::human_likeness(q_hand, *setting.free_motion);
  record.path_seconds = path_seconds(waypoints, world);
}

}  // namespace

Case parse_case(const std::string& text) {
  Case what;
  what.name = text;
  std::size_t begin = text.find('+');
  if (!set_planner(text.substr(0, begin), what)) throw InputError("case " + text + ": no such planner");
  while (begin != std::string::npos) {
    const std::size_t end = text.find('+', begin + 1);
    set_option(text.substr(begin + 1, end == std::string::npos ? end : end - begin - 1), what);
    begin = end;
  }
  return what;
}

Answer run_case(const Case& what, const Problem& problem, double range, std::int64_t budget) {
  const motion::World exact = what.exact ? exact_world(problem) : motion::World();
  motion::World world = what.exact ? exact : problem.world();
  Answer answer;
  Record& record = answer.record;
  record.planner = what.name;
  record.range = range;
  record.seed = problem.seed();
  record.goals = static_cast<int>(problem.goals().size());
  PlanResult planned;
  if (world.confirm) {  // counted apart: its cost goes with the path's length, not with the search
    world.confirm = [inner = world.confirm, &record](const auto& from, const auto& to, std::int64_t& checks) {
      std::int64_t own = 0;
      auto invalid = inner(from, to, own);
      checks += own;
      record.confirm_checks += own;
      return invalid;
    };
  }
  if (what.ompl && !problem.goals().empty()) {
    OmplOutcome outcome = plan_with_ompl(*what.ompl, ompl_query(problem), world, range, budget, problem.seed());
    record.cpu_seconds = outcome.cpu_seconds;
    planned = std::move(outcome.planned);
  } else if (what.variant) {
    planned = plan_ours(what, problem, world, range, budget, record.cpu_seconds);
  }
  record.solved = planned.status == PlanStatus::solved;
  record.status = status_name(planned.status);
  record.checks = planned.collision_checks - record.confirm_checks;
  if (what.ompl != OmplPlanner::lbkpiece1) {
    record.iterations = planned.iterations;
    if (planned.extends > 0) {
      record.valid_segments = static_cast<double>(planned.extends_grown) / static_cast<double>(planned.extends);
    }
  }
  if (!record.solved) return answer;
  record.length = planned.length;
  record.length_l1 = planned.length_l1;
  answer.path = std::move(planned.path);
  answer.goal = planned.goal;
  describe_path(problem, world, answer);
  return answer;
}

}  // namespace opponens::table2
