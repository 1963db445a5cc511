// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/path_claim.hpp"
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

/// A world with its path checker, whose trees are built when the first path asks for them.
struct CheckedWorld {
  NamedWorld named;
  std::unique_ptr<opponens::verify::PathChecker> paths{};  ///< refers to `named`

  opponens::verify::PathChecker& path_checker() {
    if (!paths) paths = std::make_unique<opponens::verify::PathChecker>(named.robot, named.scene);
    return *paths;
  }
};

/// What the checks share: worlds by their parameters, since many objects have the same, and the limits of paths.
struct Shared {
  std::map<std::string, CheckedWorld> worlds{};
  opponens::verify::PathCheckSettings limits{};

  CheckedWorld& world_of(const Json& parameters) {
    const std::string key = parameters.dump();
    const auto found = worlds.find(key);
    if (found != worlds.end()) return found->second;
    return worlds.emplace(key, CheckedWorld{load_world(parameters)}).first->second;
  }
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

Verdict grasp_verdict(const storage::Store& store, const storage::Record& record, Shared& shared) {
  const Grasp grasp = storage::decode_grasp(record);
  const SynergySet synergies = storage::decode_synergy_set(store.read(record.provenance.inputs.at(0)));
  const SynergyGroup& group = group_named(synergies, grasp.group);
  const NamedWorld& world = shared.world_of(parameters_of(record).at("world")).named;
  opponens::verify::GraspCheckSettings settings;
  settings.slack_bound = parameters_of(record).value("slack_bound", settings.slack_bound);
  Verdict verdict =
      opponens::verify::check_grasp(grasp, {&group.box, &world.hand(), &world.scene.body(world.object())}, settings);
  opponens::verify::check_arm_solutions(grasp, world.robot, world.X_RO(), settings.tolerance, verdict);
  return verdict;
}

Verdict path_verdict(const storage::Store& store, const storage::Record& record, Shared& shared) {
  CheckedWorld& checked = shared.world_of(parameters_of(record).at("world"));
  const JointPath motion{storage::decode_plan_result(record).path.joint_names,
                         std::get<Eigen::MatrixXd>(record.fields.at("motion"))};
  Verdict verdict;
  const auto claim = path_claim(store, record, checked.named, motion, verdict);
  if (!claim) return verdict;
  return checked.path_checker().check(motion, *claim, shared.limits);
}

struct Tally {
  Json failed = Json::array();
  Json verdicts = Json::array();
  std::vector<std::string> ids;
  std::int64_t certificates = 0;         ///< grasps that passed and have one, which holds
  std::int64_t without_certificate = 0;  ///< grasps that passed and have none
  Verdict worst;                         ///< of all paths together
};

void add(const std::string& id, const std::string& kind, const Verdict& verdict, Tally& tally) {
  std::string reason;
  for (const auto& one : verdict.reasons) reason += (reason.empty() ? "" : "; ") + one;
  tally.verdicts.push_back({{"id", id}, {"kind", kind}, {"passed", verdict.ok}, {"reason", reason}});
  tally.ids.push_back(id);
  if (!verdict.ok) tally.failed.push_back({{"id", id}, {"reason", reason}});
  if (verdict.ok && kind == kGrasp) ++(verdict.certified ? tally.certificates : tally.without_certificate);
  Verdict& worst = tally.worst;
  if (verdict.worst_clearance < worst.worst_clearance) {
    worst.worst_clearance = verdict.worst_clearance;
    worst.worst_pair = verdict.worst_pair;
    worst.worst_place = verdict.worst_place + " of path " + id.substr(0, 12);
  }
  worst.proven_clearance = std::min(worst.proven_clearance, verdict.proven_clearance);
  worst.worst_contact_penetration = std::max(worst.worst_contact_penetration, verdict.worst_contact_penetration);
  worst.proven_contact_penetration = std::max(worst.proven_contact_penetration, verdict.proven_contact_penetration);
}

using Check = Verdict (*)(const storage::Store&, const storage::Record&, Shared&);

void check_all(const storage::Store& store, const char* kind, Check check, Shared& shared, Progress& progress,
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
    if (verdict.ok) verdict = check(store, record, shared);
    add(entry.id, entry.kind, verdict, tally);
  }
}

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f mm", 1e3 * metres);
  return text;
}

std::vector<std::string> sentences(const VerifyOptions& options) {
  return {
      "Every file's and every object's hash was computed again and compared.",
      "What grasps and paths were made from is in the store, and their robot, scene and mesh files are the same.",
      "Grasps: rigid poses, joint limits, slack against the synergy box, contacts on both surfaces, that their "
      "wrenches positively span all forces and torques, the stored quality (non-negative least squares and descent, "
      "no shared solver), the certificates of force closure in exact arithmetic (of the stored contacts and friction, "
      "not of the world; a grasp without one is counted, not failed), and that each arm solution puts the palm where "
      "the grasp says.",
      "Paths: start, pre-grasp, grasp and the palm's poses there, joint limits, and for the whole motion, by "
      "conservative "
      "advancement and not by samples, that all bodies keep " +
          millimetres(options.clearance) +
          " from each other; on the closing segment the grasp's own links may touch the object, at most " +
          millimetres(options.max_penetration) + " deep."};
}

/// Empty when there was no grasp.
std::string certificate_sentence(const Tally& tally) {
  if (tally.certificates + tally.without_certificate == 0) return "";
  return "; " + std::to_string(tally.certificates) + " certificates of force closure hold, " +
         std::to_string(tally.without_certificate) + " grasps have none";
}

/// What was found of all paths; empty when there was none.
std::string clearance_sentence(const Verdict& worst) {
  if (!std::isfinite(worst.worst_clearance)) return "";
  std::string text = "; worst clearance " + millimetres(worst.worst_clearance) + " (" + worst.worst_pair.first +
                     " and " + worst.worst_pair.second + " " + worst.worst_place + "), proven: nowhere below " +
                     millimetres(worst.proven_clearance);
  if (worst.proven_contact_penetration > 0.0) {
    text += "; deepest contact while closing " + millimetres(worst.worst_contact_penetration) +
            ", proven: nowhere above " + millimetres(worst.proven_contact_penetration);
  }
  return text;
}

}  // namespace

int verify(const VerifyOptions& options, const Console& console) {
  storage::Store store(options.common.store, false);
  const RunLog log(store, "verify", 1);
  const auto damage = store.check();
  for (const auto& sentence : damage) Console::warn(sentence);
  if (!damage.empty()) return kStoreDamaged;

  Shared shared;
  shared.limits.proof.clearance = options.clearance;
  shared.limits.proof.max_penetration = options.max_penetration;
  Progress progress(console, "verifying");
  Tally tally;
  check_all(store, kGrasp, grasp_verdict, shared, progress, tally);
  check_all(store, kPath, path_verdict, shared, progress, tally);
  // Not its own earlier verdicts: where nothing changed, the verdict is the same object.
  const auto checked = store.list().size() - store.list(kVerdicts).size();
  Json result = document("verify");
  const Verdict& worst = tally.worst;
  result.update(
      {{"checked", checked},
       {"failed", tally.failed},
       {"certificates", tally.certificates},
       {"without_certificate", tally.without_certificate},
       {"clearance_m", options.clearance},
       {"max_penetration_m", options.max_penetration},
       {"worst_clearance_m", number(worst.worst_clearance)},
       {"worst_pair", worst.worst_pair.first.empty() ? "" : worst.worst_pair.first + " and " + worst.worst_pair.second},
       {"worst_place", worst.worst_place},
       {"proven_clearance_m", number(worst.proven_clearance)},
       {"worst_contact_penetration_m", worst.worst_contact_penetration},
       {"proven_contact_penetration_m", worst.proven_contact_penetration},
       {"checks", sentences(options)},
       {"verdicts", tally.verdicts}});
  storage::Record record{kVerdicts, "verification", provenance("verify", tally.ids, {}, Json::object(), 0), {}};
  record.fields["verdicts"] = result.dump();
  log.finish(store.commit({record}));
  for (const auto& one : tally.failed) {
    console.say("FAILED " + one.at("id").get<std::string>().substr(0, 12) + ": " + one.at("reason").get<std::string>());
  }
  console.say("checked " + std::to_string(checked) + " objects, " + std::to_string(tally.verdicts.size()) +
              " grasps and paths again: " + std::to_string(tally.failed.size()) + " failed" +
              certificate_sentence(tally) + clearance_sentence(worst));
  console.document(result.dump());
  return tally.failed.empty() ? kDone : kNoAnswer;
}

}  // namespace opponens::cli
