// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_search.hpp"

#include <algorithm>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "motion/goal_configurations.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

constexpr double kReachResolution = 0.02;  // rad, spacing of the checks along a closing segment

/// Algorithm 1, lines 6 and 7, as the search's acceptance test.
class Reach {
 public:
  explicit Reach(const NamedWorld& world)
      : world_(world),
        kinematics_(robot::make_inverse_kinematics(world.robot)),
        free_space_(world.robot, world.scene),
        closing_(world.robot, world.scene, world.hand_object_pairs()),
        depth_(world.robot, world.scene, world.object, world.hand_links()),
        X_RO_(world.X_RO()) {}

  std::string operator()(Grasp& grasp) const {
    return motion::reach(grasp, world_.robot, kinematics_, X_RO_, free_space_, closing_, kReachResolution, {&depth_});
  }

  const robot::CollisionChecker& checker() const { return free_space_; }

 private:
  const NamedWorld& world_;
  robot::InverseKinematics kinematics_;
  robot::CollisionChecker free_space_;
  robot::CollisionChecker closing_;
  motion::ContactDepth depth_;
  Eigen::Isometry3d X_RO_;
};

Json contacts_json(const std::vector<Contact>& contacts) {
  Json result = Json::array();
  for (const auto& contact : contacts) {
    result.push_back(
        {{"link", contact.link}, {"p", array(contact.p_OC)}, {"n", array(contact.n_O)}, {"mu", contact.mu}});
  }
  return result;
}

Json grasp_json(const std::string& id, const Grasp& grasp, const std::vector<std::string>& joints) {
  return {{"id", id},
          {"group", grasp.group},
          {"force_closure", grasp.quality.force_closure()},
          {"certified", grasp.certificate.has_value()},
          {"epsilon", number(grasp.quality.epsilon)},
          {"min_weight", number(grasp.quality.min_weight)},
          {"slack", grasp.slack.norm()},
          {"synergy_grasp", grasp.synergy_grasp},
          {"X_OH", pose(grasp.X_OH)},
          {"X_OH_pregrasp", pose(grasp.X_OH_pregrasp)},
          {"joints", by_name(joints, grasp.q_grasp)},
          {"pregrasp", by_name(joints, grasp.q_pregrasp)},
          {"arm_solutions", grasp.arm_solutions.size()},
          {"contacts", contacts_json(grasp.contacts)}};
}

/// The commonest reasons for a person: without the bodies that are named after a colon (the stored summary keeps them).
std::string reasons(const std::map<std::string, std::int64_t>& rejected, std::int64_t trials) {
  constexpr std::size_t kShown = 5;
  std::map<std::string, std::int64_t> merged;
  for (const auto& [reason, count] : rejected) merged[reason.substr(0, reason.find(": "))] += count;
  std::vector<std::pair<std::int64_t, std::string>> sorted;
  for (const auto& [reason, count] : merged) sorted.emplace_back(count, reason);
  std::sort(sorted.rbegin(), sorted.rend());
  std::string text;
  const auto add = [&](std::int64_t count, const std::string& reason) {
    const auto percent = 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(trials, 1));
    char part[32];
    std::snprintf(part, sizeof part, "%.0f %% ", percent);
    text += (text.empty() ? "" : ", ") + (part + reason);
  };
  std::int64_t others = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i < kShown) add(sorted[i].first, sorted[i].second);
    if (i >= kShown) others += sorted[i].first;
  }
  if (others > 0) add(others, "other");
  return text;
}

std::vector<SynergyGroup> chosen_groups(const SynergySet& set, const std::string& name) {
  if (name == "all") return set.grasp;
  for (const auto& group : set.grasp) {
    if (group.name == name) return {group};
  }
  std::string known;
  for (const auto& group : set.grasp) known += (known.empty() ? "" : ", ") + group.name;
  throw InputError("--group " + name + ": no such group; there are: " + known);
}

struct GraspTally {
  Json grasps = Json::array();
  Json groups = Json::array();
  std::vector<std::string> ids;
  std::int64_t trials = 0;
  std::int64_t evaluations = 0;
  std::map<std::string, std::int64_t> rejected;
};

void store_group(const SynergyGroup& group, const grasp::SearchResult& found, const NamedWorld& world,
                 const storage::Provenance& origin, storage::Store& store, GraspTally& tally) {
  const Json summary = {{"name", group.name},
                        {"found", found.grasps.size()},
                        {"trials", found.trials},
                        {"evaluations", found.evaluations},
                        {"rejected", found.rejected}};
  std::vector<storage::Record> records;
  for (const auto& one : found.grasps) records.push_back(storage::encode(one, origin));
  records.push_back({kGraspSearch, group.name, origin, {{"summary", summary.dump()}}});
  auto ids = store.commit(records);
  ids.pop_back();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    tally.grasps.push_back(grasp_json(ids[i], found.grasps[i], world.hand.joint_names()));
    tally.ids.push_back(ids[i]);
  }
  tally.groups.push_back(summary);
  tally.trials += found.trials;
  tally.evaluations += found.evaluations;
  for (const auto& [reason, count] : found.rejected) tally.rejected[reason] += count;
}

void say_group(const Console& console, const SynergyGroup& group, const grasp::SearchResult& found) {
  if (found.grasps.empty()) {
    console.say("group " + group.name + ": no grasp in " + std::to_string(found.trials) +
                " trials: " + reasons(found.rejected, found.trials));
    return;
  }
  char text[160];
  std::snprintf(text, sizeof text, "group %s: %zu grasps in %lld trials, best epsilon %.4f", group.name.c_str(),
                found.grasps.size(), static_cast<long long>(found.trials),
                found.grasps.front().quality.epsilon.value_or(0.0));
  console.say(text);
}

}  // namespace

int grasp(const GraspOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const int threads = thread_count(options.common.threads);
  const RunLog log(store, "grasp", threads);
  const auto synergies = newest_synergies(store);
  const NamedWorld world = load_world(options.robot, options.scene, options.object);
  require_same_joints(synergies.value, world.hand);
  const Reach reach(world);
  const auto warnings = warnings_of(world, reach.checker());
  const auto groups = chosen_groups(synergies.value, options.group);
  for (const auto& warning : warnings) console.advise(warning);

  grasp::SearchSettings settings;
  settings.count = options.count;
  settings.max_trials = options.max_trials;
  settings.min_trials = options.min_trials;
  settings.threads = threads;
  GraspTally tally;
  for (const auto& group : groups) {
    Progress progress(console, "grasps of group " + group.name);
    const auto found = grasp::search_grasps(
        world.hand, world.scene, world.object, group, synergies.value.pre_grasp.box, settings, options.common.seed,
        [&reach](Grasp& candidate) { return reach(candidate); },
        [&progress](std::int64_t done, std::int64_t total) { progress.update(done, total); });
    const Json parameters = {{"world", world.parameters},
                             {"group", group.name},
                             {"count", options.count},
                             {"max_trials", options.max_trials},
                             {"min_trials", options.min_trials}};
    const auto origin = provenance("grasp", {synergies.id}, world.files, parameters, options.common.seed);
    store_group(group, found, world, origin, store, tally);
    say_group(console, group, found);
  }
  log.finish(tally.ids);
  Json result = document("grasp");
  result.update({{"grasps", tally.grasps},
                 {"groups", tally.groups},
                 {"trials", tally.trials},
                 {"evaluations", tally.evaluations},
                 {"cpu_seconds", log.cpu_seconds()},
                 {"rejected", tally.rejected},
                 {"warnings", warnings}});
  console.document(result.dump());
  return tally.ids.empty() ? kNoAnswer : kDone;
}

}  // namespace opponens::cli
