// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <set>

#include "cli/commands.hpp"
#include "cli/grasp_causes.hpp"
#include "cli/grasp_document.hpp"
#include "cli/grasp_preconditions.hpp"
#include "cli/grasp_reach.hpp"
#include "cli/grasp_settings.hpp"
#include "cli/import_grasps.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "grasp/free_joints.hpp"
#include "grasp/given_grasps.hpp"
#include "grasp/grasp_search.hpp"
#include "grasp/robust_quality.hpp"
#include "robot/mesh.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

/// What one command works on.
struct Task {
  const GraspOptions& options;
  const Console& console;
  const NamedWorld& world;
  const Stored<SynergySet>& synergies;
  const Reach& reach;
  grasp::SearchSettings settings;
  const grasp::SearchWorld& search_world;
  storage::Store& store;
};

struct GraspTally {
  Json grasps = Json::array();
  Json groups = Json::array();
  Json refused = Json::array();  ///< of an imported file
  std::vector<std::string> ids;
  std::int64_t trials = 0;
  std::int64_t evaluations = 0;
  std::map<std::string, std::int64_t> rejected;
  std::string answer;  ///< why there is no grasp, when that was clear before any trial
};

/// Quality under errors of every grasp, each from a stream of its own.
void add_robust_quality(const Task& task, const std::string& name, std::vector<Grasp>& grasps) {
  if (task.options.noise.samples == 0 || grasps.empty()) return;
  const auto& geometry = task.world.scene.body(task.world.object()).geometry;
  const robot::MeshDistance object(std::make_shared<const robot::TriangleMesh>(robot::merge(geometry)));
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    Rng rng = stream(task.options.common.seed, "robust/" + name + "/" + std::to_string(i));
    grasps[i].robust = grasp::robust_quality(task.world.hand(), object, grasps[i], task.options.noise, rng);
  }
}

/// Stores the grasps of one search, or one file, and what was rejected.
void store_found(const Task& task, const std::string& name, const grasp::SearchResult& found, const Json& more,
                 GraspTally& tally) {
  const Json summary = {{"name", name},
                        {"found", found.grasps.size()},
                        {"trials", found.trials},
                        {"evaluations", found.evaluations},
                        {"rejected", found.rejected}};
  Json parameters = settings_json(task.options);
  parameters.update({{"world", task.world.parameters}, {"group", name}});
  parameters.update(more);
  const auto origin = provenance("grasp", {task.synergies.id}, task.world.files, parameters, task.options.common.seed);
  std::vector<storage::Record> records;
  for (const auto& one : found.grasps) records.push_back(storage::encode(one, origin));
  records.push_back({kGraspSearch, name, origin, {{"summary", summary.dump()}}});
  auto ids = task.store.commit(records);
  ids.pop_back();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    tally.grasps.push_back(grasp_json(ids[i], found.grasps[i], task.world.hand().joint_names()));
    tally.ids.push_back(ids[i]);
  }
  Json shown = summary;
  shown["causes"] = causes_json(causes_of(found.rejected, task.world.scene, task.world.object()), found.trials);
  tally.groups.push_back(shown);
  tally.trials += found.trials;
  tally.evaluations += found.evaluations;
  for (const auto& [reason, count] : found.rejected) tally.rejected[reason] += count;
}

void say_none(const Task& task, const std::string& what, const grasp::SearchResult& found) {
  const auto causes = causes_of(found.rejected, task.world.scene, task.world.object());
  task.console.say(what + ": no grasp in " + std::to_string(found.trials) +
                   (found.trials == 1 ? " trial: " : " trials: ") + shares(causes, found.trials));
  if (!causes.empty() && !causes.front().advice.empty()) task.console.say("  to try first: " + causes.front().advice);
  if (task.settings.mu == 0.0) task.console.say("  without friction (--mu 0) a grasp needs seven contacts at least");
}

void say_found(const Task& task, const std::string& what, const grasp::SearchResult& found) {
  if (found.grasps.empty()) return say_none(task, what, found);
  const Grasp& best = *std::max_element(found.grasps.begin(), found.grasps.end(), [](const Grasp& a, const Grasp& b) {
    return a.quality.epsilon.value_or(0.0) < b.quality.epsilon.value_or(0.0);
  });
  char text[160];
  std::snprintf(text, sizeof text, ": %zu grasps in %lld trials, best epsilon %.4f", found.grasps.size(),
                static_cast<long long>(found.trials), best.quality.epsilon.value_or(0.0));
  std::string line = what + text;
  if (best.robust) {
    std::snprintf(text, sizeof text,
                  "; under errors force closure in %.0f %% [%.0f, %.0f], epsilon's 5 %% quantile %.4f",
                  100.0 * best.robust->force_closure, 100.0 * best.robust->force_closure_low,
                  100.0 * best.robust->force_closure_high, best.robust->epsilon_low);
    line += text;
  }
  task.console.say(line);
}

grasp::SearchResult search(const Task& task, const SynergyGroup& group, const SynergyBox& pre_grasp) {
  const auto accept = [&task](Grasp& candidate) { return task.reach(candidate); };
  const std::uint64_t seed = task.options.common.seed;
  Progress progress(task.console, "grasps of " + group.name);
  const auto show = [&progress](std::int64_t done, std::int64_t total) { progress.update(done, total); };
  if (task.options.tips) {
    auto settings = precision_settings(task.options, task.settings.threads);
    settings.convention = grasp::default_convention(task.search_world.target, settings.mu, task.settings.edges);
    return grasp::search_precision_grasps(task.search_world, group, &pre_grasp, settings, seed, accept, show);
  }
  grasp::SearchSettings settings = task.settings;
  // Their box says where closing starts, not how far it may go.
  if (task.options.free_joints) settings.slack_bound = std::numeric_limits<double>::infinity();
  return grasp::search_grasps(task.search_world, group, pre_grasp, settings, seed, accept, show);
}

void search_group(const Task& task, const SynergyGroup& group, const SynergyBox& pre_grasp,
                  const std::vector<SynergyGroup>& named, GraspTally& tally) {
  grasp::SearchResult found = search(task, group, pre_grasp);
  if (task.options.free_joints) {  // what a free grasp is along the groups that there are
    for (Grasp& one : found.grasps) {
      const SynergyGroup& nearest = named[grasp::nearest_group(named, one.q_grasp)];
      grasp::describe_along(nearest, task.settings.slack_bound, one);
    }
  }
  add_robust_quality(task, group.name, found.grasps);
  store_found(task, group.name, found, Json::object(), tally);
  say_found(task, task.options.free_joints ? group.name : "group " + group.name, found);
}

/// The grasps of a file, held to the same checks.
void import_file(const Task& task, const std::vector<SynergyGroup>& groups, GraspTally& tally) {
  const std::filesystem::path file(task.options.import);
  const ImportedPostures imported = import_grasps(file, task.world);
  std::set<std::string> others;
  for (const auto& one : imported.postures) {
    if (one.object && *one.object != task.world.object()) others.insert(*one.object);
  }
  for (const std::string& other : others) {
    task.console.advise(file.string() + ": its grasps are of " + other + ", not of " + task.world.object() +
                        "; they are taken in the frame of " + task.world.object());
  }
  std::vector<grasp::HandPose> postures;
  for (const auto& one : imported.postures) postures.push_back(one.posture);
  auto checked = grasp::check_given({task.search_world, groups, task.synergies.value.pre_grasp.box, task.settings},
                                    postures, [&task](Grasp& candidate) { return task.reach(candidate); });
  grasp::SearchResult found;
  found.trials = static_cast<std::int64_t>(postures.size());
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (checked[i].grasp) {
      found.grasps.push_back(std::move(*checked[i].grasp));
      continue;
    }
    ++found.rejected[checked[i].reason];
    tally.refused.push_back({{"name", imported.postures[i].name}, {"reason", checked[i].reason}});
    task.console.say(imported.postures[i].name + " refused: " + checked[i].reason);
  }
  add_robust_quality(task, "imported", found.grasps);
  const Json origin = {
      {"import", {{"file", portable_name(file)}, {"sha256", file_sha256(file)}, {"form", imported.form}}}};
  store_found(task, "imported", found, origin, tally);
  task.console.say(std::to_string(found.grasps.size()) + " of " + std::to_string(found.trials) + " grasps of " +
                   file.string() + " are good here");
  if (!found.grasps.empty()) say_found(task, "imported", found);
  if (found.grasps.empty()) say_none(task, "imported", found);
}

int finish(const GraspOptions& options, const Console& console, const NamedWorld& world, const GraspTally& tally,
           const RunLog& log, const std::vector<std::string>& warnings) {
  log.finish(tally.ids);
  const auto causes = causes_of(tally.rejected, world.scene, world.object());
  Json answer = nullptr;
  if (tally.ids.empty())
    answer = tally.answer.empty() ? std::string("no grasp: ").append(shares(causes, tally.trials)) : tally.answer;
  Json result = document("grasp");
  result.update({{"object", world.object()},
                 {"grasps", tally.grasps},
                 {"groups", tally.groups},
                 {"trials", tally.trials},
                 {"evaluations", tally.evaluations},
                 {"cpu_seconds", log.cpu_seconds()},
                 {"rejected", tally.rejected},
                 {"answer", answer},
                 {"causes", causes_json(causes, tally.trials)},
                 {"warnings", warnings}});
  if (!options.import.empty()) result["refused"] = tally.refused;
  console.document(result.dump());
  return tally.ids.empty() ? kNoAnswer : kDone;
}

}  // namespace

int grasp(const GraspOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const int threads = thread_count(options.common.threads);
  const RunLog log(store, "grasp", threads);
  const auto synergies = newest_synergies(store);
  const NamedWorld world = load_world(options.robot, options.scene, options.objects);
  require_one_arm(world);
  require_same_joints(synergies.value, world.hand());
  require_graspable(world);
  const auto groups = chosen_groups(synergies.value, options);
  const Reach reach(world, options.max_penetration);
  const auto warnings = warnings_of(world, reach.checker());
  for (const auto& warning : warnings) console.advise(warning);
  GraspTally tally;
  if (const auto far = out_of_reach(world)) {
    console.say(*far);
    tally.answer = *far;
    return finish(options, console, world, tally, log, warnings);
  }
  const grasp::SearchWorld search_world = grasp::make_search_world(world.hand(), world.scene, world.object(), threads);
  const Task task{options, console, world, synergies, reach, search_settings(options, threads), search_world, store};
  if (!options.import.empty()) {
    import_file(task, groups, tally);
  } else if (options.free_joints) {
    grasp::FreeJoints free = grasp::free_joints(world.hand());
    if (options.tips) free.group.box = grasp::free_box(world.hand());  // tips are placed, they do not close
    search_group(task, free.group, free.pre_grasp, groups, tally);
  } else {
    for (const auto& group : groups) search_group(task, group, synergies.value.pre_grasp.box, groups, tally);
  }
  return finish(options, console, world, tally, log, warnings);
}

}  // namespace opponens::cli
