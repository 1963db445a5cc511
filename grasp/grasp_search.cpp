// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"
#include "core/rng.hpp"
#include "grasp/close_hand.hpp"
#include "grasp/grasp_check.hpp"
#include "grasp/grasp_objective.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_seed.hpp"
#include "grasp/hand_surface.hpp"
#include "grasp/quality.hpp"

namespace opponens::grasp {
namespace {

constexpr int kBatch = 64;           // trials between two decisions to stop
constexpr int kMaxEvaluations = 40;  // of the objective per trial

struct Trial {
  std::optional<Grasp> grasp;
  std::string reason;  ///< when there is no grasp
  std::int64_t evaluations = 0;
};

/// Everything a trial reads; made once.
struct Search {
  const robot::RobotModel& hand;
  const SynergyGroup& group;
  const SynergyBox& pre_grasp;
  const SearchSettings& settings;
  const Accept& accept;
  std::uint64_t seed;
  GraspTarget target;
  HandSurface surface;
  Eigen::VectorXd direction;
  HandCheckers checkers;
};

QualityConvention convention_of(const Search& search) {
  QualityConvention convention;
  convention.mu = search.settings.mu;
  convention.edges = search.settings.edges;
  convention.rho = search.target.rho;
  convention.origin = search.target.center_of_mass;
  return convention;
}

Grasp describe(const Search& search, const HandPose& closed, const HandPose& pregrasp, std::vector<Contact> contacts,
               GraspQuality quality) {
  const SynergyBox& box = search.group.box;
  Grasp grasp;
  grasp.group = search.group.name;
  grasp.coefficients = analysis::coordinates(box, closed.q).cwiseMax(-box.half_width).cwiseMin(box.half_width);
  grasp.slack = closed.q - analysis::configuration(box, grasp.coefficients);
  grasp.q_grasp = closed.q;
  grasp.q_pregrasp = pregrasp.q;
  grasp.X_OH = closed.X_OH;
  grasp.X_OH_pregrasp = pregrasp.X_OH;
  grasp.contacts = std::move(contacts);
  grasp.quality = std::move(quality);
  grasp.synergy_grasp = grasp.slack.norm() <= search.settings.slack_bound;
  return grasp;
}

Trial run_trial(const Search& search, std::int64_t index) {
  Rng rng = stream(search.seed, "grasp/" + search.group.name + "/" + std::to_string(index));
  GraspObjective objective(search.hand, search.surface, search.target, search.group.box);
  const auto seed = best_seed({search.hand, search.surface, search.target, search.group.box}, objective, rng);
  if (!seed) return {std::nullopt, "no seed pose with a clear palm", objective.evaluations()};
  const HandSeed best = optimize_seed(objective, *seed, search.group.box.half_width, kMaxEvaluations);
  const auto rejected = [&](std::string reason) {
    return Trial{std::nullopt, std::move(reason), objective.evaluations()};
  };
  const ClosingScene scene{search.hand, search.surface, search.target, search.group.box, search.direction};
  const auto closed = close_hand(scene, {best.X_OH, analysis::configuration(search.group.box, best.y)});
  if (!closed) return rejected("cannot be freed from the object");
  const SearchSettings& settings = search.settings;
  std::vector<Contact> contacts = find_contacts(scene, *closed, settings.contact_tolerance, settings.mu);
  if (contacts.size() < 3) return rejected("fewer than three contacts");
  GraspQuality quality = evaluate(contacts, convention_of(search));
  if (!quality.force_closure()) return rejected("not force closure");
  if (!quality.epsilon) return rejected("epsilon did not converge");  // grasps are ranked by it
  GraspLimits limits{std::vector<bool>(search.hand.links().size(), false), settings.max_penetration,
                     settings.clearance_pregrasp};
  for (const Contact& contact : contacts) limits.touching[search.hand.link_index(contact.link)] = true;
  const std::string fault = posture_fault(scene, search.checkers, *closed, limits);
  if (!fault.empty()) return rejected(fault);
  const auto pregrasp = find_pregrasp(scene, search.checkers, search.pre_grasp, *closed, limits);
  if (!pregrasp) return rejected("no clear pre-grasp");
  Grasp grasp = describe(search, *closed, *pregrasp, std::move(contacts), std::move(quality));
  if (search.accept) {
    const std::string reason = search.accept(grasp);
    if (!reason.empty()) return rejected(reason);
  }
  return {std::move(grasp), {}, objective.evaluations()};
}

/// Runs trials [first, first + count) on the settings' threads; results in trial order whatever the thread count.
std::vector<Trial> run_batch(const Search& search, std::int64_t first, int count) {
  std::vector<Trial> trials(static_cast<std::size_t>(count));
  std::atomic<int> next{0};
  std::mutex guard;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) trials[static_cast<std::size_t>(i)] = run_trial(search, first + i);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!error) error = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int t = 1; t < search.settings.threads; ++t) workers.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
  return trials;
}

bool similar(const Grasp& a, const Grasp& b, const SearchSettings& settings) {
  const Eigen::AngleAxisd turn(a.X_OH.linear().transpose() * b.X_OH.linear());
  return (a.X_OH.translation() - b.X_OH.translation()).norm() < settings.min_distance_pose &&
         std::abs(turn.angle()) < settings.min_distance_angle;
}

/// Indices of the candidates to return: best first, each different from the better ones.
std::vector<std::size_t> choose(const std::vector<Grasp>& candidates, const SearchSettings& settings) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return candidates[a].quality.epsilon.value() > candidates[b].quality.epsilon.value();
  });
  std::vector<std::size_t> chosen;
  for (const std::size_t i : order) {
    const bool repeats = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t better) {
      return similar(candidates[better], candidates[i], settings);
    });
    if (!repeats && chosen.size() < static_cast<std::size_t>(settings.count)) chosen.push_back(i);
  }
  return chosen;
}

void check_shapes(const robot::RobotModel& hand, const SynergyGroup& group, const SynergyBox& pre_grasp) {
  for (const SynergyBox* box : {&group.box, &pre_grasp}) {
    require(box->center.size() == hand.dof() && box->scale.size() == hand.dof() && box->axes.rows() == hand.dof() &&
                box->axes.cols() == box->half_width.size() && box->half_width.size() > 0,
            "search_grasps: the synergy boxes must be of the hand's joints, with at least one synergy");
  }
}

}  // namespace

void validate(const SearchSettings& s) {
  const auto check = [](bool holds, const char* field, double value, const char* constraint) {
    require(holds, [&] {
      return "SearchSettings: " + std::string(field) + " = " + std::to_string(value) + " must be " + constraint;
    });
  };
  check(s.count > 0, "count", s.count, "positive");
  check(s.max_trials > 0, "max_trials", s.max_trials, "positive");
  check(s.min_trials >= 0, "min_trials", s.min_trials, "not negative");
  check(s.mu >= 0.0 && std::isfinite(s.mu), "mu", s.mu, "finite and not negative");
  check(s.edges >= 3, "edges", s.edges, "at least 3");
  check(s.max_penetration > 0.0, "max_penetration", s.max_penetration, "positive");
  check(s.contact_tolerance > 0.0, "contact_tolerance", s.contact_tolerance, "positive");
  check(s.clearance_pregrasp >= 0.0, "clearance_pregrasp", s.clearance_pregrasp, "not negative");
  check(s.slack_bound >= 0.0, "slack_bound", s.slack_bound, "not negative");
  check(s.min_distance_pose >= 0.0, "min_distance_pose", s.min_distance_pose, "not negative");
  check(s.min_distance_angle >= 0.0, "min_distance_angle", s.min_distance_angle, "not negative");
  check(s.threads > 0, "threads", s.threads, "positive");
}

SearchResult search_grasps(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object,
                           const SynergyGroup& group, const SynergyBox& pre_grasp, const SearchSettings& settings,
                           std::uint64_t seed, const Accept& accept,
                           const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  validate(settings);
  check_shapes(hand, group, pre_grasp);
  const Eigen::VectorXd mean = hand.clip(group.box.scale.cwiseProduct(group.box.center));
  const Search search{hand,
                      group,
                      pre_grasp,
                      settings,
                      accept,
                      seed,
                      make_target(scene, object, settings.threads),
                      hand_surface(hand, mean),
                      closing_direction(group.box, pre_grasp),
                      hand_checkers(hand, scene, object)};
  SearchResult result;
  std::vector<Grasp> candidates;
  while (result.trials < settings.max_trials) {
    const int count = static_cast<int>(std::min<std::int64_t>(kBatch, settings.max_trials - result.trials));
    for (Trial& trial : run_batch(search, result.trials, count)) {
      result.evaluations += trial.evaluations;
      if (trial.grasp) {
        candidates.push_back(std::move(*trial.grasp));
      } else {
        ++result.rejected[trial.reason];
      }
    }
    result.trials += count;
    if (progress) progress(result.trials, settings.max_trials);
    if (result.trials >= settings.min_trials &&
        choose(candidates, settings).size() == static_cast<std::size_t>(settings.count)) {
      break;
    }
  }
  const std::vector<std::size_t> chosen = choose(candidates, settings);
  for (const std::size_t i : chosen) result.grasps.push_back(std::move(candidates[i]));
  if (candidates.size() > chosen.size()) {
    result.rejected["a better one was kept"] = static_cast<std::int64_t>(candidates.size() - chosen.size());
  }
  return result;
}

}  // namespace opponens::grasp
