// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/report_input.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "analysis/analyze.hpp"
#include "cli/json.hpp"
#include "cli/report_grasps.hpp"
#include "cli/report_plan.hpp"
#include "cli/report_transitions.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/require.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

using namespace opponens::report;

std::string group_label(const Demonstration& motion, const std::string& group_by) {
  return analysis::group_of(motion, group_by).value_or("(no " + group_by + ")");
}

void count_motion(const Demonstration& motion, const std::string& group_by,
                  std::map<std::string, RecordingGroup>& groups) {
  const std::string name = analysis::is_free_motion(motion) ? "free motions" : group_label(motion, group_by);
  const double seconds = motion.time(motion.time.size() - 1) - motion.time(0);
  auto& group = groups[name];
  group.duration = group.recordings == 0
                       ? Interval{seconds, seconds}
                       : Interval{std::min(group.duration.low, seconds), std::max(group.duration.high, seconds)};
  group.name = name;
  group.free_motion = analysis::is_free_motion(motion);
  group.mean_duration = (group.mean_duration * group.recordings + seconds) / (group.recordings + 1);
  group.recordings += 1;
  group.samples += static_cast<int>(motion.time.size());
}

std::string origin_sentence(int simulated, int all) {
  if (simulated == 0) return "Recorded from people.";
  if (simulated == all) return "Made by opponens simulate; no human was recorded.";
  return std::to_string(all - simulated) + " recorded from people, " + std::to_string(simulated) +
         " made by opponens simulate: no figure below is about people alone.";
}

/// Residuals per fingertip and shares of samples at a limit per joint, of the motions that were mapped alike.
void add_mapping_quality(const std::vector<Stored<Demonstration>>& motions, DemonstrationPart& part) {
  std::map<std::string, double> squares;
  std::map<std::string, double> clamped;
  double samples = 0.0;
  for (const auto& motion : motions) {
    const auto& fields = motion.record.fields;
    if (!fields.contains("tip_names") || !fields.contains("clamped_share")) continue;
    const auto count = static_cast<double>(motion.value.time.size());
    const auto& names = std::get<std::vector<std::string>>(fields.at("tip_names"));
    const auto& rms = std::get<Eigen::VectorXd>(fields.at("tip_rms"));
    const auto& share = std::get<Eigen::VectorXd>(fields.at("clamped_share"));
    for (Eigen::Index i = 0; i < rms.size(); ++i)
      squares[names[static_cast<std::size_t>(i)]] += count * rms[i] * rms[i];
    for (Eigen::Index i = 0; i < share.size(); ++i) {
      clamped[motion.value.joint_names[static_cast<std::size_t>(i)]] += count * share[i];
    }
    samples += count;
  }
  for (const auto& [name, sum] : squares) part.tip_residuals.emplace_back(name, std::sqrt(sum / samples));
  for (const auto& [name, sum] : clamped) {
    if (sum > 0.0) part.clamped_shares.emplace_back(name, sum / samples);
  }
}

DemonstrationPart demonstration_part(const std::vector<Stored<Demonstration>>& motions, const std::string& group_by) {
  DemonstrationPart part;
  part.grouped_by = group_by;
  std::map<std::string, RecordingGroup> groups;
  double squares = 0.0;  // over all samples, as retarget tells it
  double mapped = 0.0;
  for (const auto& motion : motions) {
    if (motion.value.origin == Origin::simulated) ++part.simulated;
    count_motion(motion.value, group_by, groups);
    const auto residual = motion.record.fields.find("tip_residual_rms");
    if (residual == motion.record.fields.end()) continue;
    const double value = std::get<double>(residual->second);
    const auto samples = static_cast<double>(motion.value.time.size());
    squares += value * value * samples;
    mapped += samples;
  }
  for (auto& [name, group] : groups) part.groups.push_back(std::move(group));
  add_mapping_quality(motions, part);
  if (mapped > 0.0) {
    part.mapping = parameters_of(motions.front().record).value("mapping", "");
    part.tip_residual = std::sqrt(squares / mapped);
  }
  part.source = origin_sentence(part.simulated, static_cast<int>(motions.size()));
  part.example = motions.front().value;
  return part;
}

std::optional<Coverage> coverage_from(const Json& json) {
  Coverage coverage;
  coverage.nominal = json.at("nominal");
  coverage.in_sample = json.at("in_sample");
  coverage.held_out = optional_number(json.at("held_out"));
  if (json.at("interval").is_array()) coverage.interval = Interval{json["interval"][0], json["interval"][1]};
  return coverage;
}

SynergyPart synergy_part(const Stored<SynergySet>& synergies, const Json& found) {
  SynergyPart part;
  const Json parameters = parameters_of(synergies.record);
  part.joint_names = synergies.value.joint_names;
  part.grouped_by = parameters.at("group_by");
  part.box_root = parameters.at("box_root");
  const std::vector<const SynergyGroup*> groups = groups_in_order(synergies.value);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const Json& json = found.at("groups").at(i);
    SynergyItem item;
    item.group = *groups[i];
    item.samples = json.at("samples");
    item.cluster = json.at("cluster");
    const Json& intervals = json.at("cumulative_variance_interval");
    item.cumulative_low.resize(static_cast<Eigen::Index>(intervals.size()));
    item.cumulative_high.resize(item.cumulative_low.size());
    for (std::size_t j = 0; j < intervals.size(); ++j) {
      item.cumulative_low(static_cast<Eigen::Index>(j)) = intervals[j][0];
      item.cumulative_high(static_cast<Eigen::Index>(j)) = intervals[j][1];
    }
    item.full_box = coverage_from(json.at("coverage"));
    item.reduced_box = coverage_from(json.at("coverage_k"));
    part.groups.push_back(std::move(item));
  }
  return part;
}

VerifyPart verify_part(const Json& found) {
  VerifyPart part;
  part.checks = found.at("checks").get<std::vector<std::string>>();
  part.checked = found.at("checked");
  part.worst_clearance = optional_number(found.at("worst_clearance_m"));
  part.worst_pair = found.value("worst_pair", "");
  for (const auto& one : found.at("verdicts")) {
    part.verdicts.push_back({one.at("id"), one.at("kind"), one.at("passed"), one.at("reason")});
  }
  return part;
}

std::vector<ProvenanceItem> chain_of(const storage::Store& store, const std::string& id) {
  std::vector<ProvenanceItem> items;
  std::set<std::string> seen;
  const std::function<void(const std::string&)> add = [&](const std::string& object) {
    if (!seen.insert(object).second) return;
    const auto record = store.read(object);
    const auto& origin = record.provenance;
    items.push_back({object, record.kind, record.name, origin.command, origin.inputs, origin.files, origin.parameters,
                     origin.seed, origin.program_version});
    for (const auto& input : origin.inputs) add(input);
  };
  add(id);
  return items;
}

/// The object whose world the report is about: the newest planning, else the newest grasp, else the newest search, also
/// one that found nothing: the report then says why.
std::optional<std::string> leading_object(const storage::Store& store, const std::string& synergies,
                                          const std::vector<storage::IndexEntry>& plans,
                                          const std::vector<storage::IndexEntry>& grasps) {
  if (!plans.empty()) return plans.front().id;
  if (!grasps.empty()) return grasps.front().id;
  const auto searches = made_from(store, kGraspSearch, {synergies});
  return searches.empty() ? std::nullopt : std::optional<std::string>(searches.front().id);
}

void add_world_and_results(const storage::Store& store, const Stored<SynergySet>& synergies, ReportInput& input) {
  std::map<std::string, bool> verdicts;
  if (const auto id = newest(store, kVerdicts)) {
    const Json found = Json::parse(text_field(store.read(*id), "verdicts"));
    input.verification = verify_part(found);
    for (const auto& verdict : input.verification->verdicts) verdicts[verdict.id] = verdict.passed;
  }
  const auto grasps = made_from(store, kGrasp, {synergies.id});
  std::set<std::string> grasp_ids;
  for (const auto& entry : grasps) grasp_ids.insert(entry.id);
  const auto plans = made_from(store, kPlanRuns, grasp_ids);
  const auto leading = leading_object(store, synergies.id, plans, grasps);
  if (!leading) return;
  const storage::Record record = store.read(*leading);
  const Json world = parameters_of(record).at("world");
  NamedWorld loaded = load_world(world);
  input.robot = std::move(loaded.robot);
  input.scene = std::move(loaded.scene);
  for (auto& arm : loaded.arms) {
    GraspPart part = report_grasps(store, synergies, key_of_arm(record, arm.name), *input.scene, verdicts);
    if (loaded.arms.size() > 1) part.arm = arm.name;
    if (!input.grasps) {
      input.hand = std::move(arm.hand);
      input.grasps = std::move(part);
    } else {
      input.further_hands.push_back({std::move(arm.hand), std::move(part)});
    }
  }
  input.path = path_part(store, plans);
  input.provenance = chain_of(store, input.path && !input.path->id.empty() ? input.path->id
                                     : grasps.empty()                      ? *leading
                                                                           : grasps.front().id);
}

/// The motions that a synergy set was made from, whatever the store holds beside them.
std::vector<Stored<Demonstration>> analysed_motions(const storage::Store& store, const storage::Record& synergies) {
  std::vector<Stored<Demonstration>> motions;
  for (const auto& id : synergies.provenance.inputs) {
    storage::Record record = store.read(id);
    if (record.kind != kRecording && record.kind != kHandMotion) continue;
    Demonstration value = storage::decode_demonstration(record);
    motions.push_back({id, std::move(record), std::move(value)});
  }
  if (motions.empty()) throw InputError("the newest synergy set names no recordings that it was made from");
  return motions;
}

}  // namespace

ReportInput report_input(const storage::Store& store) {
  ReportInput input;
  input.program_version = OPPONENS_VERSION;
  input.run = run_part(store);
  if (store.list(kSynergySet).empty()) {
    auto motions = hand_motions(store).newest;
    if (motions.empty()) motions = recordings(store).newest;
    if (!motions.empty()) input.demonstrations = demonstration_part(motions, "family");
    return input;
  }
  const auto synergies = newest_synergies(store);
  const auto motions = analysed_motions(store, synergies.record);
  const Json parameters = parameters_of(synergies.record);
  const Json found = Json::parse(text_field(synergies.record, "analysis"));
  input.demonstrations = demonstration_part(motions, parameters.at("group_by"));
  const bool split = parameters.value("phase", "both") != "none";
  input.transitions = transition_part(motions, found, split ? parameters.at("transition") : Json(""));
  input.synergies = synergy_part(synergies, found);
  input.provenance = chain_of(store, synergies.id);
  add_world_and_results(store, synergies, input);
  if (!input.hand && motions.front().record.kind == kHandMotion) {
    input.hand.emplace(hand_of_motion(motions.front().record));
  }
  return input;
}

}  // namespace opponens::cli
