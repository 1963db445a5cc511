// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

#include "analysis/human_likeness.hpp"
#include "analysis/statistics.hpp"
#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "motion/closing_segment.hpp"
#include "motion/edge_check.hpp"
#include "motion/goal_configurations.hpp"
#include "motion/shortcut.hpp"
#include "motion/syn_planner.hpp"
#include "motion/timing.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

using analysis::LikenessReference;

/// The query: goals are the pre-grasps of every arm solution of every grasp.
struct Query {
  Eigen::VectorXd start;
  SynergySet synergies;
  std::vector<Stored<Grasp>> grasps;
  std::vector<motion::GoalRoot> goals;       ///< goal = index into this list
  std::vector<std::size_t> grasp_of_goal;    ///< index into grasps
  std::vector<Eigen::VectorXd> q_grasp;      ///< [d] where the closing segment of each goal ends
};

const SynergyGroup& group_named(const SynergySet& set, const std::string& name) {
  const auto found = std::find_if(set.grasp.begin(), set.grasp.end(),
                                  [&](const SynergyGroup& group) { return group.name == name; });
  require(found != set.grasp.end(), "a stored grasp names the unknown group " + name);
  return *found;
}

Query make_query(const storage::Store& store, const NamedWorld& world) {
  auto synergies = newest_synergies(store);
  require_same_joints(synergies.value, world.hand);
  Query query{start_configuration(world.robot, world.scene), std::move(synergies.value), {}, {}, {}, {}};
  query.grasps = grasps_of(store, synergies.id, world.parameters);
  if (query.grasps.empty()) {
    throw InputError(store.directory().string() + ": no grasps of " + world.object +
                     " with this robot, scene and the newest synergies; run: opponens grasp");
  }
  for (std::size_t i = 0; i < query.grasps.size(); ++i) {
    const Grasp& grasp = query.grasps[i].value;
    for (const auto& arm : grasp.arm_solutions) {
      query.goals.push_back({motion::join(world.robot, arm.q_pregrasp, grasp.q_pregrasp),
                             group_named(query.synergies, grasp.group).box, static_cast<int>(query.goals.size())});
      query.grasp_of_goal.push_back(i);
      query.q_grasp.push_back(motion::join(world.robot, arm.q_grasp, grasp.q_grasp));
    }
  }
  return query;
}

/// Free motions of the hand, the reference of human-likeness; nullopt when the store has none.
std::optional<LikenessReference> free_motion_reference(const storage::Store& store) {
  std::vector<SampleStatistics> parts;
  bool simulated = false;
  for (const auto& motion : hand_motions(store)) {
    const auto kind = motion.value.labels.find("kind");
    if (kind == motion.value.labels.end() || kind->second != "free") continue;
    simulated = simulated || motion.value.origin == Origin::simulated;
    parts.push_back(analysis::moments(motion.value.q_h, motion.value.weight));
  }
  if (parts.empty()) return std::nullopt;
  return LikenessReference{simulated ? "free finger motions (simulated)" : "free finger motions",
                           analysis::pooled(parts).covariance};
}

/// Covariance of a group's grasp phase, in radians.
LikenessReference grasp_phase_reference(const SynergyGroup& group) {
  const Eigen::MatrixXd scaled = group.basis.axes * group.basis.variance.asDiagonal() * group.basis.axes.transpose();
  return {"grasp phase of group " + group.name,
          group.box.scale.asDiagonal() * scaled * group.box.scale.asDiagonal()};
}

struct Run {
  std::uint64_t seed = 0;
  PlanResult planned;           ///< as the planner returned it, up to the pre-grasp
  JointPath motion;             ///< shortened, with the closing segment
  Eigen::VectorXd times;        ///< [N] s
  int pregrasp_row = -1;
  double length = 0.0;          ///< rad, of the shortened path up to the pre-grasp
  double cpu_seconds = 0.0;     ///< of the planner; goes to documents, never into the store
  Json human_likeness = Json::array();
};

double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// What every run shares, read only.
class Planning {
 public:
  Planning(const PlanOptions& options, const NamedWorld& world, Query query,
           std::optional<LikenessReference> free_motion)
      : options_(options),
        world_(world),
        query_(std::move(query)),
        free_motion_(std::move(free_motion)),
        checker_(world.robot, world.scene),
        space_(motion::make_world(checker_, world.robot, options.resolution)) {
    settings_.variant = options.planner == "synergy" ? motion::Variant::synergy : motion::Variant::rrtconnect;
    settings_.step = options.step;
    settings_.resolution = options.resolution;
    settings_.max_checks = options.max_checks;
    settings_.time_limit = options.time_limit;
    settings_.interrupted = [] { return interrupt_requested.load(); };
    motion::validate(settings_);
  }

  const Query& query() const { return query_; }

  Run run(std::uint64_t seed) const {
    Run result;
    result.seed = seed;
    const double begin = thread_cpu_seconds();
    const auto& robot = world_.robot;
    result.planned = motion::plan(query_.start, query_.synergies.pre_grasp.box, query_.goals, robot.joint_names(),
                                  robot.hand(), robot.lower(), robot.upper(), robot.weights(), space_, settings_, seed);
    result.cpu_seconds = thread_cpu_seconds() - begin;
    if (result.planned.status == PlanStatus::solved) finish(result);
    return result;
  }

 private:
  void finish(Run& run) const {
    const auto& robot = world_.robot;
    const auto shorter = motion::shortcut(run.planned.path, robot.weights(), space_, {}, run.seed);
    run.length = shorter.length;
    const auto goal = static_cast<std::size_t>(run.planned.goal);
    const Grasp& grasp = query_.grasps[query_.grasp_of_goal[goal]].value;
    const robot::CollisionChecker closing(robot, world_.scene, touching(grasp));
    auto whole = motion::append_closing_segment(shorter.path, query_.q_grasp[goal], robot.hand(),
                                                motion::closing_world(closing, robot, options_.resolution));
    if (!whole) {
      run.planned.status = PlanStatus::no_goals;
      run.planned.detail = whole.error().detail;
      return;
    }
    run.motion = std::move(*whole);
    run.pregrasp_row = static_cast<int>(shorter.path.waypoints.rows()) - 1;
    run.times = motion::waypoint_times(run.motion, robot.velocity(), {});
    add_human_likeness(run, group_named(query_.synergies, grasp.group));
  }

  /// The grasp's own contacts: the only link-object pairs that may touch, on the closing segment alone.
  std::vector<robot::BodyPair> touching(const Grasp& grasp) const {
    std::vector<robot::BodyPair> pairs;
    for (const auto& contact : grasp.contacts) pairs.emplace_back(contact.link, world_.object);
    return pairs;
  }

  void add_human_likeness(Run& run, const SynergyGroup& group) const {
    const auto hand = [&](const Eigen::MatrixXd& q) {
      return Eigen::MatrixXd(q.middleCols(world_.robot.hand().first, world_.robot.hand().count));
    };
    const auto add = [&](const char* of, const Eigen::MatrixXd& waypoints, const LikenessReference& reference) {
      run.human_likeness.push_back(
          {{"of", of}, {"value", number(analysis::human_likeness(hand(waypoints), reference))}, {"reference", reference.name}});
    };
    const Eigen::MatrixXd shortened = run.motion.waypoints.topRows(run.pregrasp_row + 1);
    if (free_motion_) {
      add("planned", run.planned.path.waypoints, *free_motion_);
      add("shortened", shortened, *free_motion_);
    } else {
      run.human_likeness.push_back({{"of", "planned"}, {"value", nullptr}, {"reference", "none in the store"}});
    }
    add("planned", run.planned.path.waypoints, grasp_phase_reference(group));
  }

  const PlanOptions& options_;
  const NamedWorld& world_;
  Query query_;
  std::optional<LikenessReference> free_motion_;
  robot::CollisionChecker checker_;
  motion::World space_;
  motion::PlannerSettings settings_;
};

const char* status_name(PlanStatus status) {
  switch (status) {
    case PlanStatus::solved: return "solved";
    case PlanStatus::no_goals: return "no_goals";
    case PlanStatus::start_in_collision: return "start_in_collision";
    case PlanStatus::start_out_of_limits: return "start_out_of_limits";
    case PlanStatus::iteration_limit: return "iteration_limit";
    case PlanStatus::check_limit: return "check_limit";
    case PlanStatus::time_limit: return "time_limit";
    case PlanStatus::interrupted: return "interrupted";
  }
  return "unknown";
}

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
          {"goal", solved ? Json(query.grasps[query.grasp_of_goal[static_cast<std::size_t>(planned.goal)]].id) : Json(nullptr)},
          {"iterations", planned.iterations},
          {"collision_checks", planned.collision_checks},
          {"valid_segments", planned.extends > 0 ? Json(static_cast<double>(planned.extends_grown) /
                                                        static_cast<double>(planned.extends))
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
  const Json parameters = {{"world", world.parameters},
                           {"planner", options.planner},
                           {"step", options.step},
                           {"resolution", options.resolution},
                           {"max_checks", options.max_checks},
                           {"time_limit", options.time_limit}};
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
    console.say("seed " + std::to_string(run.seed) + ": " + status_name(run.planned.status) + ": " + run.planned.detail);
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
