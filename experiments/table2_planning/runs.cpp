// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table2_planning/runs.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "verify/paths.hpp"

namespace opponens::table2 {
namespace {

/// The planned path and its closing segment, proven by `verify`, which knows no collision checker of the planner.
void verify_answer(const Problem& problem, const Answer& answer, verify::PathChecker& checker, Record& record) {
  const Grasp& grasp = problem.grasp_of(answer.goal);
  const Eigen::Isometry3d& X_WO = problem.scene().body(problem.setting().object).X_WB;
  std::set<std::string> links;
  for (const Contact& contact : grasp.contacts) links.insert(contact.link);
  const verify::PathClaim claim{.start = problem.setting().start,
                                .goal = problem.goals()[static_cast<std::size_t>(answer.goal)].q,
                                .grasp = problem.q_grasp(answer.goal),
                                .closing_from = answer.path.waypoints.rows() - 1,
                                .hands = {{.X_WH_pregrasp = X_WO * grasp.X_OH_pregrasp,
                                           .X_WH_grasp = X_WO * grasp.X_OH,
                                           .object = problem.setting().object,
                                           .contact_links = std::move(links)}}};
  const verify::Verdict verdict = checker.check(problem.closed(answer.path, answer.goal), claim);
  record.verified = verdict.ok;
  record.clearance = verdict.worst_clearance;
  for (const std::string& reason : verdict.reasons) record.reason += (record.reason.empty() ? "" : "; ") + reason;
}

struct OfSeed {
  std::vector<Record> records;
  int bases_rejected = 0;
  std::vector<bool> unreachable;
  std::size_t goals = 0;
};

OfSeed run_seed(const Setting& setting, const std::vector<Trial>& trials, const RunSettings& settings, int index) {
  const Problem problem(setting, settings.first_seed + static_cast<std::uint64_t>(index), settings.jitter);
  const bool verified = index < settings.verified_share * settings.seeds;
  std::optional<verify::PathChecker> checker;
  if (verified) checker.emplace(setting.robot, problem.scene());
  OfSeed result{{}, problem.bases_rejected(), {}, problem.goals().size()};
  for (const std::string& reason : problem.reasons()) result.unreachable.push_back(!reason.empty());
  for (const Trial& trial : trials) {
    Answer answer = run_case(trial.what, problem, trial.range, settings.budget);
    if (checker && answer.record.solved) verify_answer(problem, answer, *checker, answer.record);
    result.records.push_back(std::move(answer.record));
  }
  return result;
}

void add(const OfSeed& one, Results& all) {
  all.records.insert(all.records.end(), one.records.begin(), one.records.end());
  Queries& queries = all.queries;
  ++queries.seeds;
  queries.bases_rejected += one.bases_rejected;
  queries.unreachable.resize(one.unreachable.size());
  for (std::size_t i = 0; i < one.unreachable.size(); ++i) queries.unreachable[i] += one.unreachable[i] ? 1 : 0;
  queries.goals += static_cast<double>(one.goals);
}

}  // namespace

Results run_all(const Setting& setting, const std::vector<Trial>& trials, const RunSettings& settings) {
  std::vector<OfSeed> seeds(static_cast<std::size_t>(settings.seeds));
  std::atomic<int> next{0};
  std::mutex guard;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (int i = next++; i < settings.seeds; i = next++) {
        seeds[static_cast<std::size_t>(i)] = run_seed(setting, trials, settings, i);
      }
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!error) error = std::current_exception();
      next = settings.seeds;
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < settings.threads; ++i) others.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
  Results results;
  for (const OfSeed& one : seeds) add(one, results);
  if (settings.seeds > 0) results.queries.goals /= settings.seeds;
  return results;
}

}  // namespace opponens::table2
