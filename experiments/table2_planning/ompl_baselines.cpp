// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/ompl_baselines.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateProjections.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/rrt/BiTRRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/RandomNumbers.h>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "experiments/table2_planning/cpu_time.hpp"
#include "motion/joint_metric.hpp"
#include "motion/syn_planner.hpp"

namespace opponens::table2 {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Space = ob::RealVectorStateSpace;

/// Held while any of OMPL's random generators is made: each takes the next seed of one sequence.
std::recursive_mutex& generators() {
  static std::recursive_mutex mutex;
  return mutex;
}

/// Coordinates are sqrt(weights) times joint positions.
struct Scaled {
  Eigen::VectorXd factor;
  Eigen::VectorXd q(const ob::State* state) const {
    const double* values = state->as<Space::StateType>()->values;
    return Eigen::Map<const Eigen::VectorXd>(values, factor.size()).cwiseQuotient(factor);
  }
  void set(const Eigen::VectorXd& q, ob::State* state) const {
    for (Eigen::Index j = 0; j < q.size(); ++j) state->as<Space::StateType>()->values[j] = q[j] * factor[j];
  }
};

struct Counts {
  std::int64_t checks = 0;
  std::int64_t motions = 0;
  std::int64_t valid = 0;
  std::int64_t samples = 0;  ///< uniform
  std::int64_t draws = 0;    ///< of any kind
};

constexpr double kCells = 20.0;  ///< along each of LBKPIECE1's axes

class Validity : public ob::StateValidityChecker {
 public:
  Validity(const ob::SpaceInformationPtr& si, const motion::World& world, const Scaled& scaled, Counts& counts)
      : ob::StateValidityChecker(si), world_(world), scaled_(scaled), counts_(counts) {}
  bool isValid(const ob::State* state) const override {
    const Eigen::VectorXd q = scaled_.q(state);
    return !world_.first_invalid(q, q, counts_.checks);  // as motions are asked, not as goals are
  }

 private:
  const motion::World& world_;
  const Scaled& scaled_;
  Counts& counts_;
};

class Motions : public ob::MotionValidator {
 public:
  Motions(const ob::SpaceInformationPtr& si, const motion::World& world, const Scaled& scaled, Counts& counts)
      : ob::MotionValidator(si), world_(world), scaled_(scaled), counts_(counts) {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    ++counts_.motions;
    const bool valid = !world_.first_invalid(scaled_.q(from), scaled_.q(to), counts_.checks);
    counts_.valid += valid ? 1 : 0;
    return valid;
  }
  bool checkMotion(const ob::State* from, const ob::State* to, std::pair<ob::State*, double>& last) const override {
    if (checkMotion(from, to)) return true;
    last.second = 0.0;  // nothing is known of what lies between
    if (last.first != nullptr) si_->copyState(last.first, from);
    return false;
  }

 private:
  const motion::World& world_;
  const Scaled& scaled_;
  Counts& counts_;
};

/// As OMPL's sampler of this space, from our stream and from the part of the space that our planner samples.
class Sampler : public ob::StateSampler {
 public:
  Sampler(const ob::StateSpace* space, motion::JointInterval part, std::uint64_t seed, Counts& counts)
      : ob::StateSampler(space), part_(std::move(part)), rng_(stream(seed, "table2/ompl")), counts_(counts) {}
  void sampleUniform(ob::State* state) override {
    ++counts_.samples;
    const bool anywhere = rng_.uniform() < motion::PlannerSettings().full_space_probability;
    each(state, [&](std::size_t j, double low, double high) {
      const auto i = static_cast<Eigen::Index>(j);
      return anywhere ? rng_.uniform(low, high) : rng_.uniform(part_.lower[i], part_.upper[i]);
    });
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    const double* center = near->as<Space::StateType>()->values;
    each(state, [&](std::size_t j, double low, double high) {
      return rng_.uniform(std::max(low, center[j] - distance), std::min(high, center[j] + distance));
    });
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    const double* center = mean->as<Space::StateType>()->values;
    each(state, [&](std::size_t j, double low, double high) {
      return std::min(high, std::max(low, center[j] + deviation * rng_.normal()));
    });
  }

 private:
  template <typename Draw>
  void each(ob::State* state, const Draw& draw) {
    ++counts_.draws;
    const ob::RealVectorBounds& bounds = space_->as<Space>()->getBounds();
    for (std::size_t j = 0; j < bounds.low.size(); ++j) {
      state->as<Space::StateType>()->values[j] = draw(j, bounds.low[j], bounds.high[j]);
    }
  }
  motion::JointInterval part_;  ///< in the space's scaled coordinates
  Rng rng_;
  Counts& counts_;
};

/// What our planner samples of this query, scaled.
motion::JointInterval sampled_part(const OmplQuery& query, const Eigen::VectorXd& factor) {
  motion::PlanQuery same{{query.start, {}, -1}, {}, query.joint_names, query.lower, query.upper, query.weights};
  for (const Eigen::VectorXd& q : query.goals) same.goals.push_back({q, {}, 0});
  const motion::JointInterval part = motion::sampled_part(same, motion::PlannerSettings().sampled_range);
  return {part.lower.cwiseProduct(factor), part.upper.cwiseProduct(factor)};
}

ob::PlannerPtr make_planner(OmplPlanner which, const ob::SpaceInformationPtr& si, double range) {
  const auto ranged = [range](auto planner) -> ob::PlannerPtr {
    planner->setRange(range);
    return planner;
  };
  if (which == OmplPlanner::rrtconnect) return ranged(std::make_shared<og::RRTConnect>(si));
  if (which == OmplPlanner::lbkpiece1) {
    // Its cells are those of the first three joints, which carry the hand: OMPL's own choice for 22 joints, random
    // projections, leaves nearly every motion in a cell of its own.
    const auto planner = std::make_shared<og::LBKPIECE1>(si);
    const ob::RealVectorBounds& bounds = si->getStateSpace()->as<Space>()->getBounds();
    std::vector<double> sizes;
    for (std::size_t j = 0; j < 3; ++j) sizes.push_back((bounds.high[j] - bounds.low[j]) / kCells);
    planner->setProjectionEvaluator(std::make_shared<ob::RealVectorOrthogonalProjectionEvaluator>(
        si->getStateSpace(), sizes, std::vector<unsigned>{0, 1, 2}));
    return ranged(planner);
  }
  return ranged(std::make_shared<og::BiTRRT>(si));
}

/// One problem in OMPL's terms. Made under the lock.
struct Setup {
  Scaled scaled;
  Counts counts;
  std::shared_ptr<Space> space;
  ob::SpaceInformationPtr si;
  ob::ProblemDefinitionPtr problem;
  ob::PlannerPtr planner;

  Setup(OmplPlanner which, const OmplQuery& query, const motion::World& world, double range, std::uint64_t seed)
      : scaled{query.weights.cwiseSqrt()} {
    const auto d = static_cast<unsigned>(query.lower.size());
    space = std::make_shared<Space>(d);
    ob::RealVectorBounds bounds(d);
    for (unsigned j = 0; j < d; ++j) {
      bounds.setLow(j, query.lower[j] * scaled.factor[j]);
      bounds.setHigh(j, query.upper[j] * scaled.factor[j]);
    }
    space->setBounds(bounds);
    space->setStateSamplerAllocator([this, seed, part = sampled_part(query, scaled.factor)](const ob::StateSpace* of) {
      const std::lock_guard lock(generators());
      return std::make_shared<Sampler>(of, part, seed, counts);
    });
    si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker(std::make_shared<Validity>(si, world, scaled, counts));
    si->setMotionValidator(std::make_shared<Motions>(si, world, scaled, counts));
    si->setup();
    problem = std::make_shared<ob::ProblemDefinition>(si);
    ob::ScopedState<> state(si);
    scaled.set(query.start, state.get());
    problem->addStartState(state);
    const auto goals = std::make_shared<ob::GoalStates>(si);
    for (const Eigen::VectorXd& q : query.goals) {
      scaled.set(q, state.get());
      goals->addState(state);
    }
    problem->setGoal(goals);
    planner = make_planner(which, si, range);
    planner->setProblemDefinition(problem);
    planner->setup();
    counts = {};
  }
};

std::unique_ptr<Setup> make_setup(OmplPlanner which, const OmplQuery& query, const motion::World& world, double range,
                                  std::uint64_t seed) {
  const std::lock_guard lock(generators());
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed % 4294967291U + 1U));
  return std::make_unique<Setup>(which, query, world, range, seed);
}

bool confirmed(const Eigen::MatrixXd& waypoints, const motion::World& world, std::int64_t& checks) {
  if (!world.confirm) return true;
  for (Eigen::Index i = 1; i < waypoints.rows(); ++i) {
    if (world.confirm(waypoints.row(i - 1).transpose(), waypoints.row(i).transpose(), checks)) return false;
  }
  return true;
}

Eigen::MatrixXd waypoints_of(const Setup& setup) {
  const auto* path = setup.problem->getSolutionPath()->as<og::PathGeometric>();
  Eigen::MatrixXd waypoints(static_cast<Eigen::Index>(path->getStateCount()), setup.scaled.factor.size());
  for (std::size_t i = 0; i < path->getStateCount(); ++i) {
    waypoints.row(static_cast<Eigen::Index>(i)) = setup.scaled.q(path->getState(static_cast<unsigned>(i)));
  }
  return waypoints;
}

int nearest_goal(const OmplQuery& query, const Eigen::VectorXd& q) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < query.goals.size(); ++i) {
    const double distance = motion::distance(query.weights, query.goals[i], q);
    if (distance < least) {
      least = distance;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

/// Solves once; whether there is a confirmed answer, which `planned` then holds.
bool attempt(Setup& setup, const OmplQuery& query, const motion::World& world, std::int64_t max_checks,
             PlanResult& planned) {
  const std::int64_t before = planned.collision_checks;
  // A lazy planner may go on for long without a check.
  const ob::PlannerTerminationCondition enough([&setup, before, max_checks] {
    return before + setup.counts.checks >= max_checks || setup.counts.draws >= max_checks;
  });
  const bool solved = setup.planner->solve(enough) == ob::PlannerStatus::EXACT_SOLUTION;
  planned.collision_checks += setup.counts.checks;
  planned.extends += setup.counts.motions;
  planned.extends_grown += setup.counts.valid;
  planned.iterations += setup.counts.samples;
  if (!solved) return false;
  Eigen::MatrixXd waypoints = waypoints_of(setup);
  if (!confirmed(waypoints, world, planned.collision_checks)) return false;
  planned.goal = nearest_goal(query, waypoints.row(waypoints.rows() - 1).transpose());
  planned.length = motion::path_length(query.weights, waypoints);
  planned.length_l1 = motion::path_length_l1(query.weights, waypoints);
  planned.path = {query.joint_names, std::move(waypoints)};
  return true;
}

}  // namespace

OmplOutcome plan_with_ompl(OmplPlanner planner, const OmplQuery& query, const motion::World& world, double range,
                           std::int64_t max_checks, std::uint64_t seed) {
  require(!query.goals.empty() && max_checks > 0, "plan_with_ompl: goals and a limit are needed");
  OmplOutcome outcome;
  outcome.planned.status = PlanStatus::check_limit;
  // A search that begins again has a seed of its own.
  for (std::uint64_t again = 0; outcome.planned.collision_checks < max_checks; ++again) {
    const auto setup = make_setup(planner, query, world, range, seed + 1000003 * again);
    const double begin = thread_cpu_seconds();
    const bool solved = attempt(*setup, query, world, max_checks, outcome.planned);
    outcome.cpu_seconds += thread_cpu_seconds() - begin;
    if (!solved && setup->counts.draws >= max_checks) break;
    if (!solved) continue;
    outcome.planned.status = PlanStatus::solved;
    break;
  }
  return outcome;
}

}  // namespace opponens::table2
