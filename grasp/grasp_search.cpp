// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "analysis/synergy_box.hpp"
#include "core/require.hpp"
#include "core/rng.hpp"
#include "grasp/certificate.hpp"
#include "grasp/close_hand.hpp"
#include "grasp/distinct_grasps.hpp"
#include "grasp/given_grasps.hpp"
#include "grasp/grasp_check.hpp"
#include "grasp/grasp_objective.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_seed.hpp"
#include "grasp/hand_surface.hpp"
#include "grasp/in_parallel.hpp"
#include "grasp/quality.hpp"
#include "grasp/random_vector.hpp"

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
  const SearchWorld& world;
  const SynergyGroup& group;
  const SynergyBox& pre_grasp;
  const SearchSettings& settings;
  const Accept& accept;
  std::uint64_t seed;
  Eigen::VectorXd direction;
};

Grasp describe(const Search& search, const HandPose& closed, const HandPose& pregrasp, std::vector<Contact> contacts,
               GraspQuality quality) {
  Grasp grasp;
  grasp.q_grasp = closed.q;
  grasp.q_pregrasp = pregrasp.q;
  grasp.X_OH = closed.X_OH;
  grasp.X_OH_pregrasp = pregrasp.X_OH;
  grasp.contacts = std::move(contacts);
  grasp.quality = std::move(quality);
  describe_along(search.group, search.settings.slack_bound, grasp);
  return grasp;
}

/// From a hand near the object to a grasp better than `incumbent` (an epsilon), or the reason why it is none.
Trial attempt(const Search& search, const HandPose& start, double incumbent) {
  const auto rejected = [](std::string reason) { return Trial{std::nullopt, std::move(reason)}; };
  const SearchWorld& world = search.world;
  const SearchSettings& settings = search.settings;
  const ClosingScene scene{world.hand, world.surface, world.target, search.group.box, search.direction};
  const auto closed = close_hand(scene, start);
  if (!closed) return rejected("cannot be freed from the object");
  std::vector<Contact> contacts = find_contacts(scene, *closed, settings.contact_tolerance, settings.mu);
  if (contacts.size() < 3) return rejected("fewer than three contacts");
  QualityRequest request;
  if (incumbent > 0.0) request.at_least = incumbent;
  GraspQuality quality = evaluate(contacts, default_convention(world.target, settings.mu, settings.edges), request);
  if (quality.state == ClosureState::below_incumbent) return rejected("no better");
  if (!quality.force_closure()) return rejected("not force closure");
  if (!quality.epsilon) return rejected("epsilon did not converge");  // grasps are ranked by it
  if (*quality.epsilon <= incumbent) return rejected("no better");
  const GraspLimits limits =
      grasp_limits(world.hand, links_of(contacts), settings.max_penetration, settings.clearance_pregrasp);
  const std::string fault = posture_fault(scene, world.checkers, *closed, limits);
  if (!fault.empty()) return rejected(fault);
  const auto pregrasp = find_pregrasp(scene, world.checkers, search.pre_grasp, *closed, limits);
  if (!pregrasp) return rejected("no clear pre-grasp");
  Grasp grasp = describe(search, *closed, *pregrasp, std::move(contacts), std::move(quality));
  grasp.certificate = certify(grasp.contacts, grasp.quality);
  if (!grasp.certificate) return rejected("closure cannot be certified");
  if (search.accept) {
    const std::string reason = search.accept(grasp);
    if (!reason.empty()) return rejected(reason);
  }
  return {std::move(grasp), {}};
}

Trial run_trial(const Search& search, std::int64_t index) {
  Rng rng = stream(search.seed, "grasp/" + search.group.name + "/" + std::to_string(index));
  const SearchWorld& world = search.world;
  const SynergyBox& box = search.group.box;
  GraspObjective objective(world.hand, world.surface, world.target, box);
  const auto seed = best_seed({world.hand, world.surface, world.target, box}, objective, rng);
  if (!seed) return {std::nullopt, "no seed pose with a clear palm", objective.evaluations()};
  const HandSeed best = optimize_seed(objective, *seed, box.half_width, kMaxEvaluations);
  Trial trial = attempt(search, {best.X_OH, analysis::configuration(box, best.y)}, 0.0);
  trial.evaluations = objective.evaluations();
  return trial;
}

/// A hand near a grasp: palm and synergy coordinates changed by normal deviates, `scale` times 8 mm, 0.12 rad and a
/// quarter of the box's half widths; what the grasp has beside its synergies stays.
HandPose neighbour(const Search& search, const Grasp& grasp, double scale, Rng& rng) {
  const SynergyBox& box = search.group.box;
  const Eigen::Vector3d shift = 0.008 * scale * normal_vector(rng);
  const Eigen::Vector3d turn = 0.12 * scale * normal_vector(rng);
  Eigen::VectorXd y(box.half_width.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = 0.25 * scale * box.half_width[i] * rng.normal();
  HandPose pose{grasp.X_OH, grasp.q_grasp + box.scale.cwiseProduct(box.axes * y)};
  const Eigen::Vector3d palm = grasp.X_OH * search.world.surface.palm_center;
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
  pose.X_OH.linear() = rotation * grasp.X_OH.linear();
  pose.X_OH.translation() = palm + shift + rotation * (grasp.X_OH.translation() - palm);
  return pose;
}

/// Random ascent from a grasp: closes from neighbouring starts and keeps what is better; the neighbourhood grows where
/// that succeeds and shrinks where it does not (the 1/5 rule, Rechenberg 1973). A grasp along the synergies is left
/// only for another.
Grasp improve(const Search& search, Grasp grasp, std::size_t rank) {
  Rng rng = stream(search.seed, "improve/" + search.group.name + "/" + std::to_string(rank));
  double scale = 1.0;
  for (int i = 0; i < search.settings.improvements; ++i) {
    const HandPose start = neighbour(search, grasp, scale, rng);
    Trial trial = attempt(search, start, grasp.quality.epsilon.value());
    const bool kept = trial.grasp && (trial.grasp->synergy_grasp || !grasp.synergy_grasp);
    if (kept) grasp = std::move(*trial.grasp);
    scale = std::clamp(scale * (kept ? 1.5 : 0.9), 0.1, 1.5);
  }
  return grasp;
}

/// Runs trials [first, first + count); results in trial order whatever the thread count.
std::vector<Trial> run_batch(const Search& search, std::int64_t first, int count) {
  std::vector<Trial> trials(static_cast<std::size_t>(count));
  in_parallel(search.settings.threads, count,
              [&](int i) { trials[static_cast<std::size_t>(i)] = run_trial(search, first + i); });
  return trials;
}

/// The best different ones of the candidates and of what they become when they are taken uphill (two may come together,
/// so the starts stay candidates). Between rounds `pause` may throw.
std::vector<Grasp> refined(const Search& search, std::vector<Grasp> candidates, const std::function<void()>& pause) {
  const SearchSettings& settings = search.settings;
  if (candidates.empty()) return {};
  // No more than trials found: a start and what became of it count once.
  const int count = std::min(settings.count, static_cast<int>(candidates.size()));
  if (settings.improvements > 0) {
    const std::vector<std::size_t> starts = distinct_grasps(candidates, 2 * settings.count, settings.distances);
    for (std::size_t first = 0; first < starts.size(); first += static_cast<std::size_t>(settings.threads)) {
      const std::size_t round = std::min(static_cast<std::size_t>(settings.threads), starts.size() - first);
      std::vector<Grasp> better(round);
      in_parallel(settings.threads, static_cast<int>(round), [&](int i) {
        const std::size_t rank = first + static_cast<std::size_t>(i);
        better[rank - first] = improve(search, candidates[starts[rank]], rank);
      });
      for (Grasp& grasp : better) candidates.push_back(std::move(grasp));
      pause();
    }
  }
  return best_distinct(std::move(candidates), count, settings.distances);
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
  check(s.improvements >= 0, "improvements", s.improvements, "not negative");
  validate(s.distances);
  check(s.threads > 0, "threads", s.threads, "positive");
}

SearchWorld make_search_world(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object,
                              int threads) {
  return {hand, make_target(scene, object, threads), hand_surface(hand, 0.5 * (hand.lower() + hand.upper())),
          hand_checkers(hand, scene, object)};
}

SearchResult search_grasps(const robot::RobotModel& hand, const robot::Scene& scene, const std::string& object,
                           const SynergyGroup& group, const SynergyBox& pre_grasp, const SearchSettings& settings,
                           std::uint64_t seed, const Accept& accept, const SearchProgress& progress) {
  validate(settings);
  return search_grasps(make_search_world(hand, scene, object, settings.threads), group, pre_grasp, settings, seed,
                       accept, progress);
}

SearchResult search_grasps(const SearchWorld& world, const SynergyGroup& group, const SynergyBox& pre_grasp,
                           const SearchSettings& settings, std::uint64_t seed, const Accept& accept,
                           const SearchProgress& progress) {
  validate(settings);
  check_shapes(world.hand, group, pre_grasp);
  const Search search{world, group, pre_grasp, settings, accept, seed, closing_direction(group.box, pre_grasp)};
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
        distinct_grasps(candidates, settings.count, settings.distances).size() ==
            static_cast<std::size_t>(settings.count)) {
      break;
    }
  }
  const std::size_t found = candidates.size();
  result.grasps = refined(search, std::move(candidates), [&] {
    if (progress) progress(result.trials, settings.max_trials);
  });
  if (found > result.grasps.size()) {
    result.rejected["a better one was kept"] = static_cast<std::int64_t>(found - result.grasps.size());
  }
  return result;
}

}  // namespace opponens::grasp
