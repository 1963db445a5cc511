// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/planning.hpp"
#include "cli/stored.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

/// Runs are independent of each other, so they may be spread over threads in any way.
std::vector<Run> run_all(const Planning& planning, const PlanOptions& options, int threads, Progress& progress) {
  std::vector<Run> runs(static_cast<std::size_t>(options.runs));
  std::atomic<std::size_t> next{0};
  std::atomic<std::int64_t> done{0};
  const auto work = [&](bool reports) {
    for (std::size_t i = next++; i < runs.size() && !interrupt_requested; i = next++) {
      runs[i] = planning.run(options.common.seed + i);
      ++done;
      if (reports && !interrupt_requested) progress.update(done, options.runs);
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < std::min(threads, options.runs); ++i) others.emplace_back(work, false);
  work(true);
  others.clear();
  if (interrupt_requested) throw Interrupted();
  return runs;
}

Json run_json(const Run& run, const Query& query) {
  const auto& planned = run.planned;
  const bool solved = planned.status == PlanStatus::solved;
  const Json likeness = solved ? run.human_likeness.front() : Json{{"value", nullptr}, {"reference", nullptr}};
  return {{"seed", run.seed},
          {"status", status_name(planned.status)},
          {"detail", planned.detail},
          {"goal",
           solved ? Json(query.grasps[query.grasp_of_goal[static_cast<std::size_t>(planned.goal)]].id) : Json(nullptr)},
          {"iterations", planned.iterations},
          {"collision_checks", planned.collision_checks},
          {"valid_segments",
           planned.extends > 0 ? Json(static_cast<double>(planned.extends_grown) / static_cast<double>(planned.extends))
                               : Json(nullptr)},
          {"cpu_seconds", run.cpu_seconds},
          {"length_rad", solved ? Json(planned.length) : Json(nullptr)},
          {"length_l1_rad", solved ? Json(planned.length_l1) : Json(nullptr)},
          {"shortened_length_rad", solved ? Json(run.length) : Json(nullptr)},
          {"human_likeness", likeness.at("value")},
          {"human_likeness_reference", likeness.at("reference")},
          {"human_likeness_all", run.human_likeness}};
}

storage::Record run_record(const Run& run, const Query& query, const PlanOptions& options, const NamedWorld& world) {
  const auto& grasp = query.grasps[query.grasp_of_goal[static_cast<std::size_t>(run.planned.goal)]];
  const Json parameters = {
      {"world", world.parameters},        {"planner", options.planner},       {"step", options.step},
      {"resolution", options.resolution}, {"max_checks", options.max_checks}, {"time_limit", options.time_limit}};
  std::vector<std::string> inputs = {grasp.id};
  for (const auto& other : query.grasps) {
    if (other.id != grasp.id) inputs.push_back(other.id);
  }
  auto record = storage::encode(run.planned, provenance("plan", inputs, world.files, parameters, run.seed));
  record.kind = kPath;
  record.name = world.object + " by group " + grasp.value.group;
  record.fields["goal_grasp"] = grasp.id;
  record.fields["motion"] = run.motion.waypoints;
  record.fields["times"] = run.times;
  record.fields["pregrasp_row"] = std::int64_t{run.pregrasp_row};
  record.fields["human_likeness"] = run.human_likeness.dump();
  return record;
}

void say_run(const Console& console, const Run& run, const Query& query) {
  if (run.planned.status != PlanStatus::solved) {
    console.say("seed " + std::to_string(run.seed) + ": " + status_name(run.planned.status) + ": " +
                run.planned.detail);
    return;
  }
  char text[240];
  std::snprintf(text, sizeof text,
                "seed %llu: reached a grasp of group %s; %lld iterations, %lld collision checks, length %.2f rad "
                "(shortened %.2f), %.1f s long",
                static_cast<unsigned long long>(run.seed),
                query.grasps[query.grasp_of_goal[static_cast<std::size_t>(run.planned.goal)]].value.group.c_str(),
                static_cast<long long>(run.planned.iterations), static_cast<long long>(run.planned.collision_checks),
                run.planned.length, run.length, run.times(run.times.size() - 1));
  console.say(text);
}

Json path_json(const Run& run) {
  if (run.planned.status != PlanStatus::solved) return nullptr;
  return {{"joint_names", run.motion.joint_names},
          {"waypoints", rows(run.motion.waypoints)},
          {"times", array(run.times)},
          {"pregrasp_row", run.pregrasp_row}};
}

}  // namespace

int plan(const PlanOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const int threads = thread_count(options.common.threads);
  const RunLog log(store, "plan", threads);
  const NamedWorld world = load_world(options.robot, options.scene, options.object);
  const Planning planning(options, world, make_query(store, world), free_motion_reference(store));
  Progress progress(console, "planning");
  const auto runs = run_all(planning, options, threads, progress);

  Json result = document("plan");
  result["runs"] = Json::array();
  std::vector<storage::Record> records;
  const Run* shown = nullptr;
  for (const auto& run : runs) {
    result["runs"].push_back(run_json(run, planning.query()));
    say_run(console, run, planning.query());
    if (run.planned.status != PlanStatus::solved) continue;
    if (shown == nullptr) shown = &run;
    records.push_back(run_record(run, planning.query(), options, world));
  }
  const auto ids = store.commit(records);
  log.finish(ids);
  result["path"] = shown == nullptr ? Json(nullptr) : path_json(*shown);
  result["ids"] = ids;
  console.document(result.dump());
  return records.size() == runs.size() ? kDone : kNoAnswer;
}

}  // namespace opponens::cli
