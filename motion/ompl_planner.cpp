// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/ompl_planner.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>

#include "motion/plan_run.hpp"

namespace opponens::motion {
namespace {

namespace ob = ompl::base;

/// Appends the bounds of a space's coordinates in the order of StateSpace::copyToReals.
void append_bounds(const ob::StateSpace& space, std::vector<double>& lower, std::vector<double>& upper) {
  if (space.isCompound()) {
    for (const ob::StateSpacePtr& part : space.as<ob::CompoundStateSpace>()->getSubspaces()) {
      append_bounds(*part, lower, upper);
    }
    return;
  }
  if (space.getType() != ob::STATE_SPACE_REAL_VECTOR) {
    throw ompl::Exception("SynPlanner",
                          "the space '" + space.getName() + "' is not a RealVectorStateSpace or a compound of such");
  }
  const ob::RealVectorBounds& bounds = space.as<ob::RealVectorStateSpace>()->getBounds();
  lower.insert(lower.end(), bounds.low.begin(), bounds.low.end());
  upper.insert(upper.end(), bounds.high.begin(), bounds.high.end());
}

Eigen::VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd configuration_of(const ob::StateSpace& space, const ob::State* state) {
  std::vector<double> reals;
  space.copyToReals(reals, state);
  return as_vector(reals);
}

void set_state(const ob::StateSpace& space, const Eigen::VectorXd& q, ob::State* state) {
  space.copyFromReals(state, std::vector<double>(q.begin(), q.end()));
}

/// The planner's two questions, asked of the space information.
World world_of(const ob::SpaceInformationPtr& si) {
  World world;
  const auto from = std::make_shared<ob::ScopedState<>>(si);
  const auto to = std::make_shared<ob::ScopedState<>>(si);
  world.first_invalid = [si, from, to](const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                       std::int64_t& checks) -> std::optional<double> {
    set_state(*si->getStateSpace(), q_from, from->get());
    set_state(*si->getStateSpace(), q_to, to->get());
    std::pair<ob::State*, double> last_valid{nullptr, 0.0};
    const unsigned segments = si->getStateSpace()->validSegmentCount(from->get(), to->get());
    if (si->checkMotion(from->get(), to->get(), last_valid)) {
      checks += segments;
      return std::nullopt;
    }
    // The discrete validator goes forward in equal steps and stops at the first that is invalid.
    const double steps = last_valid.second * segments;
    checks += static_cast<std::int64_t>(std::lround(steps)) + 1;
    return std::min(1.0, (steps + 1.0) / segments);
  };
  world.free = [si, from](const Eigen::MatrixXd& batch, std::int64_t& checks) {
    std::vector<bool> free;
    for (const auto& row : batch.rowwise()) {
      set_state(*si->getStateSpace(), row.transpose(), from->get());
      free.push_back(si->isValid(from->get()));
    }
    checks += batch.rows();
    return free;
  };
  return world;
}

std::optional<std::vector<const ob::State*>> goal_states(const ob::GoalPtr& goal) {
  if (goal && goal->hasType(ob::GOAL_STATES)) {
    const auto* states = goal->as<ob::GoalStates>();
    std::vector<const ob::State*> result;
    for (unsigned i = 0; i < states->getStateCount(); ++i) result.push_back(states->getState(i));
    return result;
  }
  if (goal && goal->hasType(ob::GOAL_STATE))
    return std::vector<const ob::State*>{goal->as<ob::GoalState>()->getState()};
  return std::nullopt;
}

ob::PlannerStatus status_of(PlanStatus status) {
  switch (status) {
    case PlanStatus::solved:
      return ob::PlannerStatus::EXACT_SOLUTION;
    case PlanStatus::start_in_collision:
    case PlanStatus::start_out_of_limits:
      return ob::PlannerStatus::INVALID_START;
    case PlanStatus::no_goals:
      return ob::PlannerStatus::INVALID_GOAL;
    default:
      return ob::PlannerStatus::TIMEOUT;
  }
}

}  // namespace

SynPlanner::SynPlanner(const ob::SpaceInformationPtr& si, PlannerSettings settings, std::uint64_t seed)
    : ob::Planner(si, "SynPlanner"), settings_(std::move(settings)), seed_(seed) {
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  declare_parameters();
  declare_progress();
}

void SynPlanner::declare_parameters() {
  declareParam<double>("range", this, &SynPlanner::setRange, &SynPlanner::getRange, "0.:1.:10000.");
  const auto declare = [this]<typename Value>(const std::string& name, Value PlannerSettings::*field) {
    params_.declareParam<Value>(
        name, [this, field](Value value) { settings_.*field = value; }, [this, field] { return settings_.*field; });
  };
  declare("full_space_probability", &PlannerSettings::full_space_probability);
  declare("max_iterations", &PlannerSettings::max_iterations);
  declare("max_checks", &PlannerSettings::max_checks);
  params_.declareParam<std::string>(
      "variant",
      [this](const std::string& name) {
        const auto variant = variant_named(name);
        if (!variant) throw ompl::Exception(getName(), "no variant is called " + name);
        settings_.variant = *variant;
      },
      [this] { return std::string(kVariantNames[static_cast<std::size_t>(settings_.variant)]); });
}

void SynPlanner::declare_progress() {
  const auto declare = [this](const std::string& name, const std::atomic<std::int64_t>& value) {
    addPlannerProgressProperty(name + " INTEGER", [&value] { return std::to_string(value.load()); });
  };
  declare("iterations", progress_.iterations);
  declare("collision checks", progress_.collision_checks);
  declare("states", progress_.vertices);
}

void SynPlanner::set_settings(const PlannerSettings& settings) {
  validate(settings);
  settings_ = settings;
}

PlanQuery SynPlanner::query_of(const std::vector<const ob::State*>& goals) const {
  if (goal_projections_.size() > 1 && goal_projections_.size() != goals.size()) {
    throw ompl::Exception(getName(), std::to_string(goal_projections_.size()) + " goal projections for " +
                                         std::to_string(goals.size()) + " goal states");
  }
  const ob::StateSpace& space = *si_->getStateSpace();
  std::vector<double> lower;
  std::vector<double> upper;
  append_bounds(space, lower, upper);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(lower.size()));
  PlanQuery query{{configuration_of(space, pdef_->getStartState(0)), start_projection_},
                  {},
                  {},
                  as_vector(lower),
                  as_vector(upper),
                  weights_.size() > 0 ? weights_ : ones};
  for (std::size_t j = 0; j < lower.size(); ++j) query.joint_names.push_back(std::to_string(j));
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const Projection projection = goal_projections_.empty()       ? Projection()
                                  : goal_projections_.size() == 1 ? goal_projections_.front()
                                                                  : goal_projections_[i];
    query.goals.push_back({configuration_of(space, goals[i]), projection, static_cast<int>(i)});
  }
  return query;
}

ob::PlannerStatus SynPlanner::solve(const ob::PlannerTerminationCondition& ptc) {
  checkValidity();
  result_ = {};
  graphs_.clear();
  bridge_.reset();
  const auto goals = goal_states(pdef_->getGoal());
  if (!goals) return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  if (pdef_->getStartStateCount() == 0) return ob::PlannerStatus::INVALID_START;
  PlannerSettings settings = settings_;
  settings.interrupted = [&ptc, asked = settings_.interrupted] { return ptc() || (asked && asked()); };
  settings.progress = [this, told = settings_.progress](const PlanProgress& now) {
    progress_.iterations = now.iterations;
    progress_.collision_checks = now.collision_checks;
    progress_.vertices = now.vertices;
    if (told) told(now);
  };
  const PlanQuery query = query_of(*goals);
  const World world = world_of(si_);
  motion::validate(query, world, settings);
  PlanRun run(query, world, settings, seed_);
  result_ = run.planner();
  graphs_ = {run.start_graph(), run.goal_graph()};
  bridge_ = run.bridge();
  if (result_.status == PlanStatus::solved) {
    auto path = std::make_shared<ompl::geometric::PathGeometric>(si_);
    ob::ScopedState<> state(si_);
    for (const auto& row : result_.path.waypoints.rowwise()) {
      set_state(*si_->getStateSpace(), row.transpose(), state.get());
      path->append(state.get());
    }
    pdef_->addSolutionPath(path, false, 0.0, getName());
  }
  return status_of(result_.status);
}

void SynPlanner::getPlannerData(ob::PlannerData& data) const {
  Planner::getPlannerData(data);
  std::vector<std::vector<ob::ScopedState<>>> states;  // data takes copies of them at the end
  for (const Graph& graph : graphs_) {
    auto& of_graph = states.emplace_back();
    for (int i = 0; i < graph.forest.size(); ++i) {
      set_state(*si_->getStateSpace(), graph.forest.vertex(i), of_graph.emplace_back(si_).get());
    }
  }
  const auto vertex = [&](std::size_t graph, int i) {
    return ob::PlannerDataVertex(states[graph][static_cast<std::size_t>(i)].get(), static_cast<int>(graph) + 1);
  };
  for (std::size_t graph = 0; graph < graphs_.size(); ++graph) {
    const SampleForest& forest = graphs_[graph].forest;
    for (int i = 0; i < forest.size(); ++i) {
      const int parent = forest.parent(i);
      if (parent < 0) {
        graph == 0 ? data.addStartVertex(vertex(graph, i)) : data.addGoalVertex(vertex(graph, i));
      } else if (graph == 0) {
        data.addEdge(vertex(graph, parent), vertex(graph, i));
      } else {
        data.addEdge(vertex(graph, i), vertex(graph, parent));
      }
    }
  }
  if (bridge_) data.addEdge(vertex(0, bridge_->vertex_a), vertex(1, bridge_->vertex_b));
  data.decoupleFromPlanner();
}

void SynPlanner::clear() {
  Planner::clear();
  result_ = {};
  graphs_.clear();
  bridge_.reset();
}

}  // namespace opponens::motion
