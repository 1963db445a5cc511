// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/path_likeness.hpp"
#include "cli/plan_diagnostics.hpp"
#include "cli/planning.hpp"
#include "cli/stored.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

using Reached = std::vector<const Stored<Grasp>*>;  ///< [driven arms]

/// Runs are independent of each other, so they may be spread over threads in any way. Those that were finished when the
/// user interrupted are returned, in the order of their seeds. What the interrupted ones had found is said.
std::vector<Run> run_all(const Planning& planning, const PlanOptions& options, int threads, Progress& progress,
                         const Console& console) {
  std::vector<std::optional<Run>> runs(static_cast<std::size_t>(options.runs));
  std::atomic<std::size_t> next{0};
  std::atomic<std::int64_t> done{0};
  std::mutex guard;
  std::exception_ptr error;
  const auto work = [&](bool reports) {
    try {
      for (std::size_t i = next++; i < runs.size() && !interrupt_requested; i = next++) {
        Run run = planning.run(options.common.seed + i);
        if (run.planned.status == PlanStatus::interrupted) {
          const std::lock_guard lock(guard);
          say_failure(console, run, planning);
          continue;
        }
        runs[i] = std::move(run);
        ++done;
        if (reports) progress.update(done, options.runs);
      }
    } catch (const Interrupted&) {  // the loops end by the same flag
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!error) error = std::current_exception();
      next = runs.size();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < std::min(threads, options.runs); ++i) others.emplace_back(work, false);
    work(true);
  }
  if (error) std::rethrow_exception(error);
  std::vector<Run> finished;
  for (auto& run : runs) {
    if (run) finished.push_back(std::move(*run));
  }
  return finished;
}

Json run_json(const Run& run, const Planning& planning, const NamedWorld& world) {
  const auto& planned = run.planned;
  const bool solved = planned.status == PlanStatus::solved;
  const Json likeness = solved ? run.human_likeness.front() : Json{{"value", nullptr}, {"reference", nullptr}};
  const Reached reached = solved ? planning.query().grasps_at(planned.goal) : Reached();
  Json json = {{"seed", run.seed},
               {"status", status_name(planned.status)},
               {"detail", planned.detail},
               {"goal", solved ? Json(reached.front()->id) : Json(nullptr)},
               {"goal_index", solved ? planned.goal : -1},
               {"iterations", planned.iterations},
               {"extends", planned.extends},
               {"extends_grown", planned.extends_grown},
               {"collision_checks", planned.collision_checks},
               {"valid_segments", planned.extends > 0 ? Json(static_cast<double>(planned.extends_grown) /
                                                             static_cast<double>(planned.extends))
                                                      : Json(nullptr)},
               {"length_rad", solved ? Json(planned.length) : Json(nullptr)},
               {"length_l1_rad", solved ? Json(planned.length_l1) : Json(nullptr)},
               {"shortened_length_rad", solved ? Json(run.length) : Json(nullptr)},
               {"duration_s", solved ? Json(run.trajectory.times(run.trajectory.times.size() - 1)) : Json(nullptr)},
               {"stops", solved ? Json(run.stops) : Json(nullptr)},
               {"box_distance", run.box_distance},
               {"human_likeness", likeness.at("value")},
               {"human_likeness_reference", likeness.at("reference")},
               {"human_likeness_all", run.human_likeness},
               {"goals_refused", planned.goals_refused},
               {"diagnostics", diagnostics_json(run, planning)}};
  for (std::size_t i = 0; reached.size() > 1 && i < reached.size(); ++i) {
    json["goals"].push_back({{"arm", world.arms[i].name}, {"grasp", reached[i]->id}});
  }
  return json;
}

Json parameters_json(const PlanOptions& options, const NamedWorld& world) {
  Json parameters = {{"world", world.parameters},
                     {"planner", options.planner},
                     {"step", options.step},
                     {"resolution", options.resolution},
                     {"max_checks", options.max_checks},
                     {"time_limit", options.time_limit.value_or(0.0)},
                     {"smooth", options.smooth},
                     {"speed", options.speed}};
  const auto add = [&](const char* name, const std::optional<double>& own) {
    if (own) parameters[name] = *own;
  };
  if (world.arms.size() > 1) parameters["pairs"] = options.pairs;
  add("arm_step", options.own_step.arm);
  add("hand_step", options.own_step.hand);
  add("arm_resolution", options.own_resolution.arm);
  add("hand_resolution", options.own_resolution.hand);
  return parameters;
}

/// Names the grasps that a path reaches: the first arm's in goal_grasp, each further arm's in a field of its own.
void add_goal_grasps(storage::Record& record, const Reached& reached, const NamedWorld& world) {
  record.fields["goal_grasp"] = reached.front()->id;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const GraspingArm& arm = world.arms[i];
    if (i > 0) record.fields[goal_grasp_field(arm.name)] = reached[i]->id;
    record.name += (i > 0 ? " and " : "") + arm.object + " by group " + reached[i]->value.group;
  }
}

storage::Record run_record(const Run& run, const Query& query, const storage::Provenance& origin,
                           const NamedWorld& world) {
  const Reached reached = query.grasps_at(run.planned.goal);
  auto record = storage::encode(run.planned, origin);
  record.provenance.seed = run.seed;
  record.provenance.inputs.clear();
  for (const auto* grasp : reached) record.provenance.inputs.push_back(grasp->id);
  for (const auto& other : query.grasps) {
    if (std::find(reached.begin(), reached.end(), &other) == reached.end())
      record.provenance.inputs.push_back(other.id);
  }
  record.kind = kPath;
  record.name.clear();
  add_goal_grasps(record, reached, world);
  record.fields["motion"] = run.motion.waypoints;
  record.fields["times"] = run.trajectory.times;
  record.fields["velocities"] = run.trajectory.velocities;
  record.fields["accelerations"] = run.trajectory.accelerations;
  record.fields["bridge_row"] = std::int64_t{run.planned.bridge_row};
  record.fields["pregrasp_row"] = std::int64_t{run.pregrasp_row};
  record.fields["human_likeness"] = run.human_likeness.dump();
  return record;
}

/// "a grasp of group 1", or "grasps of groups 1 (right) and 3 (left)".
std::string goal_words(const Reached& reached, const NamedWorld& world) {
  if (reached.size() == 1) return "a grasp of group " + reached.front()->value.group;
  std::string words;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    words += (i == 0 ? "grasps of groups " : " and ") + reached[i]->value.group + " (" + world.arms[i].name + ")";
  }
  return words;
}

void say_run(const Console& console, const Run& run, const Planning& planning, const NamedWorld& world) {
  if (run.planned.status != PlanStatus::solved) {
    say_failure(console, run, planning);
    return;
  }
  char text[320];
  std::snprintf(text, sizeof text,
                "; %lld iterations, %lld collision checks; length %.2f rad as "
                "planned (%.2f rad as a sum over joints), %.2f rad shortened; %.1f s long",
                static_cast<long long>(run.planned.iterations), static_cast<long long>(run.planned.collision_checks),
                run.planned.length, run.planned.length_l1, run.length,
                run.trajectory.times(run.trajectory.times.size() - 1));
  console.say("seed " + std::to_string(run.seed) + ": reached " +
              goal_words(planning.query().grasps_at(run.planned.goal), world) + text);
  say_diagnostics(console, run, planning);
}

Json path_json(const Run& run) {
  if (run.planned.status != PlanStatus::solved) return nullptr;
  return {{"joint_names", run.motion.joint_names},
          {"waypoints", rows(run.motion.waypoints)},
          {"times", array(run.trajectory.times)},
          {"velocities", rows(run.trajectory.velocities)},
          {"accelerations", rows(run.trajectory.accelerations)},
          {"pregrasp_row", run.pregrasp_row}};
}

/// The paths of the solved runs, and after them the record of every run: a success rate needs those that failed.
std::vector<storage::Record> records_of(const std::vector<Run>& runs, const Planning& planning,
                                        const PlanOptions& options, const NamedWorld& world) {
  const Query& query = planning.query();
  std::vector<std::string> inputs;
  for (const auto& grasp : query.grasps) inputs.push_back(grasp.id);
  const auto origin = provenance("plan", inputs, world.files, parameters_json(options, world), options.common.seed);
  std::vector<storage::Record> records;
  Json all = Json::array();
  for (const auto& run : runs) {
    all.push_back(run_json(run, planning, world));
    all.back()["path"] = nullptr;
    if (run.planned.status != PlanStatus::solved) continue;
    records.push_back(run_record(run, query, origin, world));
    all.back()["path"] = storage::content_hash(records.back());
  }
  records.push_back({kPlanRuns, options.planner, origin, {{"runs", all.dump()}}});
  return records;
}

/// Times differ from run to run: they go to the log.
Json times_json(const std::vector<Run>& runs, const PlanOptions& options, const std::string& id) {
  Json seconds = Json::array();
  for (const auto& run : runs) seconds.push_back(run.cpu_seconds);
  return {{"planner", options.planner}, {"plan_runs", id}, {"planner_cpu_seconds", seconds}};
}

Json advise(const NamedWorld& world, const Planning& planning, const Console& console) {
  auto warnings = warnings_of(world, planning.checker());
  if (const auto count = planning.goals_left_out(); count > 0) {
    warnings.push_back(std::to_string(count) + " of " + std::to_string(count + planning.query().goals.size()) +
                       " goals left out: their closing segment is not valid at this resolution");
  }
  if (planning.pairs()) {
    if (auto words = left_out_words(*planning.pairs()); !words.empty()) warnings.push_back(std::move(words));
  }
  if (!planning.keeps_clearance()) {
    warnings.emplace_back(
        "at the start something is nearer than the clearance of 0.6 mm: such pairs keep only nine tenths of what they "
        "have there");
  }
  for (const auto& warning : warnings) console.advise(warning);
  return warnings;
}

void say_pairs(const PairTally& tally, const Console& console) {
  console.say(
      std::to_string(tally.kept) + " pairs of grasps are goals, of " + std::to_string(tally.possible) +
      " possible ones" +
      (tally.asked < tally.possible ? ", of which the first " + std::to_string(tally.asked) + " were asked" : ""));
}

}  // namespace

int plan(const PlanOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const int threads = thread_count(options.common.threads);
  const RunLog log(store, "plan", threads);
  const NamedWorld world = load_world(options.robot, options.scene, options.objects);
  const Planning planning(options, world, make_query(store, world), free_motion_reference(store));
  Json result = document("plan");
  result["warnings"] = advise(world, planning, console);
  if (planning.pairs()) {
    result["pairs"] = pairs_json(*planning.pairs());
    say_pairs(*planning.pairs(), console);
  }
  Progress progress(console, "planning");
  const auto runs = run_all(planning, options, threads, progress, console);
  if (runs.empty()) throw Interrupted();

  auto ids = store.commit(records_of(runs, planning, options, world));
  log.finish(ids, times_json(runs, options, ids.back()));
  if (interrupt_requested) throw Interrupted();
  result["plan_runs"] = ids.back();
  ids.pop_back();
  result["ids"] = ids;
  result["runs"] = Json::array();
  const Run* shown = nullptr;
  for (const auto& run : runs) {
    result["runs"].push_back(run_json(run, planning, world));
    result["runs"].back()["cpu_seconds"] = run.cpu_seconds;
    say_run(console, run, planning, world);
    if (shown == nullptr && run.planned.status == PlanStatus::solved) shown = &run;
  }
  result["path"] = shown == nullptr ? Json(nullptr) : path_json(*shown);
  console.document(result.dump());
  return ids.size() == runs.size() ? kDone : kNoAnswer;
}

}  // namespace opponens::cli
