// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/precision_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"
#include "grasp/certificate.hpp"
#include "grasp/in_parallel.hpp"
#include "grasp/quality.hpp"
#include "grasp/tip_seed.hpp"

namespace opponens::grasp {
namespace {

constexpr double kGapAtMost = 2e-5;  // m, of a returned grasp's tips

std::vector<Contact> contacts_of(const PrecisionSpace& space, const std::vector<TipTouch>& touches) {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::string& link = space.hand.links()[static_cast<std::size_t>(space.tips[i].link)].name;
    contacts.push_back({link, touches[i].p_O, touches[i].n_O, space.convention.mu});
  }
  return contacts;
}

std::string fault_of(const PrecisionSearch& search, const HandPose& pose, const GraspLimits& limits,
                     const Eigen::VectorXd& direction) {
  const PrecisionSpace& space = search.space;
  if (!space.hand.within_limits(pose.q, 1e-6)) return "joint beyond its limit";
  return posture_fault({space.hand, space.surface, space.target, space.box, direction}, search.checkers, pose, limits);
}

/// Runs trials [first, first + count) on the settings' threads, in trial order whatever the thread count.
std::vector<PrecisionTrial> run_trials(const PrecisionSearch& search, std::uint64_t seed, std::int64_t first,
                                       int count) {
  std::vector<PrecisionTrial> trials(static_cast<std::size_t>(count));
  in_parallel(search.settings.threads, count, [&](int i) {
    Rng rng = stream(seed, "precision/" + search.group + "/" + std::to_string(first + i));
    trials[static_cast<std::size_t>(i)] = precision_trial(search, rng);
  });
  return trials;
}

}  // namespace

void validate(const PrecisionSettings& s) {
  const auto check = [](bool holds, const char* field, double value, const char* constraint) {
    require(holds, [&] {
      return "PrecisionSettings: " + std::string(field) + " = " + std::to_string(value) + " must be " + constraint;
    });
  };
  check(s.count > 0, "count", s.count, "positive");
  check(s.max_trials > 0, "max_trials", s.max_trials, "positive");
  check(s.enough >= s.count, "enough", s.enough, "at least count");
  check(s.draws > 0, "draws", s.draws, "positive");
  check(s.max_evaluations > 0, "max_evaluations", s.max_evaluations, "positive");
  check(s.mu >= 0.0 && std::isfinite(s.mu), "mu", s.mu, "finite and not negative");
  check(s.max_penetration > 0.0, "max_penetration", s.max_penetration, "positive");
  check(s.clearance_pregrasp >= 0.0, "clearance_pregrasp", s.clearance_pregrasp, "not negative");
  validate(s.distances);
  check(s.threads > 0, "threads", s.threads, "positive");
}

PrecisionTrial precision_trial(const PrecisionSearch& search, Rng& rng) {
  const PrecisionSpace& space = search.space;
  PrecisionProblem problem(space);
  const auto rejected = [&](std::string reason) {
    return PrecisionTrial{std::nullopt, std::move(reason), problem.evaluations()};
  };
  const auto seed = best_tip_seed(space, problem, search.settings.draws, rng);
  if (!seed) return rejected("no chord through the object");
  PrecisionRun run(problem, *seed, space.box);
  solve(run, problem, search.settings.solver, search.settings.max_evaluations);
  auto x = run.best();
  if (!x) return rejected("the optimiser met no finite point");
  if (!(close_gaps(problem, run, *x) <= kGapAtMost)) return rejected("the tips do not reach the surface");
  SlopeRows slopes;
  std::vector<Contact> contacts = contacts_of(space, problem.touches(*x, slopes));
  GraspQuality quality = evaluate(contacts, space.convention);
  if (!quality.force_closure()) return rejected("not force closure");
  if (!quality.epsilon) return rejected("epsilon did not converge");
  const HandSeed best = problem.at(*x);
  const HandPose pose{best.X_OH, analysis::configuration(space.box, best.y)};
  // All tips may touch, also one that is 0.02 mm away.
  const GraspLimits limits =
      grasp_limits(space.hand, links_of(contacts), space.max_penetration, search.settings.clearance_pregrasp);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(space.hand.dof());
  const Eigen::VectorXd direction =
      search.pre_grasp != nullptr ? closing_direction(space.box, *search.pre_grasp) : still;
  const std::string fault = fault_of(search, pose, limits, direction);
  if (!fault.empty()) return rejected(fault);
  Grasp grasp;
  if (search.pre_grasp != nullptr) {
    const ClosingScene scene{space.hand, space.surface, space.target, space.box, direction};
    const auto open = find_pregrasp(scene, search.checkers, *search.pre_grasp, pose, limits);
    if (!open) return rejected("no clear pre-grasp");
    grasp.q_pregrasp = open->q;
    grasp.X_OH_pregrasp = open->X_OH;
  }
  grasp.group = search.group;
  grasp.coefficients = best.y;
  grasp.slack = still;
  grasp.q_grasp = pose.q;
  grasp.X_OH = pose.X_OH;
  grasp.contacts = std::move(contacts);
  grasp.quality = std::move(quality);
  grasp.certificate = certify(grasp.contacts, grasp.quality);
  if (!grasp.certificate) return rejected("closure cannot be certified");
  if (search.accept) {
    std::string reason = search.accept(grasp);
    if (!reason.empty()) return rejected(std::move(reason));
  }
  return {std::move(grasp), {}, problem.evaluations()};
}

SearchResult search_precision_grasps(const PrecisionSearch& search, std::uint64_t seed) {
  const PrecisionSettings& settings = search.settings;
  validate(settings);
  SearchResult result;
  std::vector<Grasp> found;
  while (result.trials < settings.max_trials && found.size() < static_cast<std::size_t>(settings.enough)) {
    const int count = static_cast<int>(std::min<std::int64_t>(settings.threads, settings.max_trials - result.trials));
    for (PrecisionTrial& trial : run_trials(search, seed, result.trials, count)) {
      // What other threads did after the deciding trial is dropped, so that the answer depends on no thread count.
      if (found.size() == static_cast<std::size_t>(settings.enough)) break;
      ++result.trials;
      result.evaluations += trial.evaluations;
      if (trial.grasp) {
        found.push_back(std::move(*trial.grasp));
      } else {
        ++result.rejected[trial.reason];
      }
    }
    if (search.progress) search.progress(result.trials, settings.max_trials);
  }
  const std::size_t accepted = found.size();
  result.grasps = best_distinct(std::move(found), settings.count, settings.distances, [&](const Grasp& grasp) {
    return settings.goal == PrecisionGoal::min_weight ? grasp.quality.min_weight : grasp.quality.epsilon;
  });
  if (accepted > result.grasps.size()) {
    result.rejected["a better one was kept"] = static_cast<std::int64_t>(accepted - result.grasps.size());
  }
  return result;
}

SearchResult search_precision_grasps(const robot::RobotModel& hand, const robot::Scene& scene,
                                     const std::string& object, const SynergyGroup& group, const SynergyBox* pre_grasp,
                                     const PrecisionSettings& settings, std::uint64_t seed) {
  validate(settings);
  return search_precision_grasps(make_search_world(hand, scene, object, settings.threads), group, pre_grasp, settings,
                                 seed);
}

SearchResult search_precision_grasps(const SearchWorld& world, const SynergyGroup& group, const SynergyBox* pre_grasp,
                                     const PrecisionSettings& settings, std::uint64_t seed, const Accept& accept,
                                     const SearchProgress& progress) {
  validate(settings);
  require(group.box.center.size() == world.hand.dof() && group.box.half_width.size() > 0,
          "search_precision_grasps: the synergy box must be of the hand's joints, with at least one synergy");
  const PrecisionSpace space =
      make_precision_space(world.hand, world.surface, world.target, group.box, settings.tips,
                           settings.convention.value_or(default_convention(world.target, settings.mu)), settings.goal,
                           settings.max_penetration);
  return search_precision_grasps({space, settings, world.checkers, group.name, pre_grasp, accept, progress}, seed);
}

}  // namespace opponens::grasp
