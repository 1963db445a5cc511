// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "storage/codec.hpp"
#include "verify/grasps.hpp"
#include "verify/paths.hpp"

namespace opponens::cli {
namespace {

using opponens::verify::Verdict;

/// Worlds by their parameters: many objects share one.
class Worlds {
 public:
  const NamedWorld& of(const Json& parameters) {
    const std::string key = parameters.dump();
    const auto found = worlds_.find(key);
    if (found != worlds_.end()) return found->second;
    return worlds_.emplace(key, load_world(parameters.at("robot"), parameters.at("scene"), parameters.at("object")))
        .first->second;
  }

 private:
  std::map<std::string, NamedWorld> worlds_;
};

/// What the object was made from must be there, and robot, scene and meshes be the same as then.
void check_origin(const storage::Record& record, const std::set<std::string>& stored, Verdict& verdict) {
  for (const auto& id : record.provenance.inputs) {
    if (!stored.contains(id)) verdict.fail("made from " + id + ", which is not in the store");
  }
  for (const auto& [name, hash] : record.provenance.files) {
    try {
      if (file_sha256(find_file(name)) != hash) verdict.fail(name + " has changed since");
    } catch (const InputError&) {
      verdict.fail(name + " is not there any more");
    }
  }
}

Verdict grasp_verdict(const storage::Store& store, const storage::Record& record, Worlds& worlds) {
  const Grasp grasp = storage::decode_grasp(record);
  const SynergySet synergies = storage::decode_synergy_set(store.read(record.provenance.inputs.at(0)));
  const SynergyGroup& group = group_named(synergies, grasp.group);
  const NamedWorld& world = worlds.of(parameters_of(record).at("world"));
  const opponens::verify::GraspCheckSettings settings;
  Verdict verdict =
      opponens::verify::check_grasp(grasp, {&group.box, &world.hand, &world.scene.body(world.object)}, settings);
  opponens::verify::check_arm_solutions(grasp, world.robot, world.X_RO(), settings.tolerance, verdict);
  return verdict;
}

/// The arm solution that a path uses: the one nearest to its pre-grasp (check_path asks for equality).
const ArmSolution& solution_used(const Grasp& grasp, const Eigen::VectorXd& q_arm) {
  return *std::min_element(grasp.arm_solutions.begin(), grasp.arm_solutions.end(),
                           [&](const ArmSolution& a, const ArmSolution& b) {
                             return (a.q_pregrasp - q_arm).norm() < (b.q_pregrasp - q_arm).norm();
                           });
}

Verdict path_verdict(const storage::Store& store, const storage::Record& record, Worlds& worlds) {
  const Json parameters = parameters_of(record);
  const NamedWorld& world = worlds.of(parameters.at("world"));
  const Grasp grasp = storage::decode_grasp(store.read(std::get<std::string>(record.fields.at("goal_grasp"))));
  const PlanResult planned = storage::decode_plan_result(record);
  const JointPath motion{planned.path.joint_names, std::get<Eigen::MatrixXd>(record.fields.at("motion"))};
  opponens::verify::PathClaim claim;
  claim.start = start_configuration(world.robot, world.scene);
  claim.closing_from = std::get<std::int64_t>(record.fields.at("pregrasp_row"));
  Verdict verdict;
  if (grasp.arm_solutions.empty() || claim.closing_from < 0 || claim.closing_from >= motion.waypoints.rows()) {
    verdict.fail("its grasp has no arm solution, or its pre-grasp is no waypoint");
    return verdict;
  }
  const ArmSolution& arm =
      solution_used(grasp, motion.waypoints.row(claim.closing_from).head(world.robot.arm().count).transpose());
  claim.goal.resize(world.robot.dof());
  claim.goal << arm.q_pregrasp, grasp.q_pregrasp;
  claim.grasp = Eigen::VectorXd(world.robot.dof());
  *claim.grasp << arm.q_grasp, grasp.q_grasp;
  const Eigen::Isometry3d X_WO = world.scene.body(world.object).X_WB;
  claim.X_WH_pregrasp = X_WO * grasp.X_OH_pregrasp;
  claim.X_WH_grasp = X_WO * grasp.X_OH;
  claim.object = world.object;
  for (const auto& contact : grasp.contacts) claim.contact_links.insert(contact.link);
  opponens::verify::PathCheckSettings settings;
  // The stored resolution may only make the check denser: a coarsely planned path is not checked coarsely.
  settings.spacing = std::min(settings.spacing, parameters.at("resolution").get<double>() / 10.0);
  return opponens::verify::check_path(motion, claim, world.robot, world.scene, settings);
}

struct Tally {
  Json failed = Json::array();
  Json verdicts = Json::array();
  std::vector<std::string> ids;
  double worst_clearance = std::numeric_limits<double>::infinity();
  std::pair<std::string, std::string> worst_pair;
  double worst_penetration = 0.0;
};

void add(const std::string& id, const std::string& kind, const Verdict& verdict, Tally& tally) {
  std::string reason;
  for (const auto& one : verdict.reasons) reason += (reason.empty() ? "" : "; ") + one;
  tally.verdicts.push_back({{"id", id}, {"kind", kind}, {"passed", verdict.ok}, {"reason", reason}});
  tally.ids.push_back(id);
  if (!verdict.ok) tally.failed.push_back({{"id", id}, {"reason", reason}});
  if (verdict.worst_clearance < tally.worst_clearance) {
    tally.worst_clearance = verdict.worst_clearance;
    tally.worst_pair = verdict.worst_pair;
  }
  tally.worst_penetration = std::max(tally.worst_penetration, verdict.worst_contact_penetration);
}

using Check = Verdict (*)(const storage::Store&, const storage::Record&, Worlds&);

void check_all(const storage::Store& store, const char* kind, Check check, Worlds& worlds, Progress& progress,
               Tally& tally) {
  const auto entries = store.list(kind);
  std::set<std::string> stored;
  for (const auto& entry : store.list()) stored.insert(entry.id);
  std::int64_t done = 0;
  for (const auto& entry : entries) {
    progress.update(done++, static_cast<std::int64_t>(entries.size()));
    const auto record = store.read(entry.id);
    Verdict verdict;
    check_origin(record, stored, verdict);
    if (verdict.ok) verdict = check(store, record, worlds);
    add(entry.id, entry.kind, verdict, tally);
  }
}

std::vector<std::string> sentences() {
  return {
      "Every file's and every object's hash was computed again and compared.",
      "What grasps and paths were made from is in the store, and their robot, scene and mesh files are the same.",
      "Grasps: rigid poses, joint limits, slack against the synergy box, contacts on both surfaces, that their "
      "wrenches positively span all forces and torques, the stored quality (non-negative least squares and descent, "
      "no shared solver), and that each arm solution puts the palm where the grasp says.",
      "Paths: start, pre-grasp, grasp and the palm's poses there, joint limits, and collision every 0.002 rad (or a "
      "tenth of the planner's resolution where that is less) by a loop of its own, between the planner's own samples; "
      "contacts only between the grasp's own links and the object, on the closing segment."};
}

}  // namespace

int verify(const VerifyOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const RunLog log(store, "verify", 1);
  const auto damage = store.check();
  for (const auto& sentence : damage) Console::warn(sentence);
  if (!damage.empty()) return kStoreDamaged;

  Worlds worlds;
  Progress progress(console, "verifying");
  Tally tally;
  check_all(store, kGrasp, grasp_verdict, worlds, progress, tally);
  check_all(store, kPath, path_verdict, worlds, progress, tally);
  // Not its own earlier verdicts: where nothing changed, the verdict is the same object.
  const auto checked = store.list().size() - store.list(kVerdicts).size();
  Json result = document("verify");
  result.update(
      {{"checked", checked},
       {"failed", tally.failed},
       {"worst_clearance_m", number(tally.worst_clearance)},
       {"worst_pair", tally.worst_pair.first.empty() ? "" : tally.worst_pair.first + " and " + tally.worst_pair.second},
       {"worst_contact_penetration_m", tally.worst_penetration},
       {"checks", sentences()},
       {"verdicts", tally.verdicts}});
  storage::Record record{kVerdicts, "verification", provenance("verify", tally.ids, {}, Json::object(), 0), {}};
  record.fields["verdicts"] = result.dump();
  log.finish(store.commit({record}));
  for (const auto& one : tally.failed) {
    console.say("FAILED " + one.at("id").get<std::string>().substr(0, 12) + ": " + one.at("reason").get<std::string>());
  }
  char clearance[64] = "";
  if (std::isfinite(tally.worst_clearance)) {
    std::snprintf(clearance, sizeof clearance, "; worst clearance %.2f mm", 1e3 * tally.worst_clearance);
  }
  console.say("checked " + std::to_string(checked) + " objects, " + std::to_string(tally.verdicts.size()) +
              " grasps and paths again: " + std::to_string(tally.failed.size()) + " failed" + clearance);
  console.document(result.dump());
  return tally.failed.empty() ? kDone : kNoAnswer;
}

}  // namespace opponens::cli
