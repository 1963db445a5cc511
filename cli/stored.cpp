// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/stored.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "cli/resources.hpp"
#include "core/require.hpp"
#include "storage/codec.hpp"

namespace opponens::cli {
namespace {

double wall_now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

double cpu_now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string utc_date(double seconds) {
  const auto time = static_cast<std::time_t>(seconds);
  std::tm parts{};
  gmtime_r(&time, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::string source_of(const storage::Store& store, const storage::IndexEntry& entry) {
  return text_field(store.read(entry.id), "label.source");
}

Motions motions_of(const storage::Store& store, const char* kind) {
  const MotionEntries entries = newest_motions(store, kind);
  Motions motions{{}, entries.superseded};
  for (const auto& entry : entries.newest) {
    storage::Record record = store.read(entry.id);
    Demonstration value = storage::decode_demonstration(record);
    motions.newest.push_back({entry.id, std::move(record), std::move(value)});
  }
  return motions;
}

}  // namespace

storage::Provenance provenance(const std::string& command, std::vector<std::string> inputs,
                               const std::vector<std::filesystem::path>& files, const nlohmann::json& parameters,
                               std::uint64_t seed) {
  storage::Provenance result;
  result.command = command;
  result.inputs = std::move(inputs);
  for (const auto& file : files) result.files[recorded_name(file)] = file_sha256(file);
  result.parameters = parameters.dump();
  result.seed = seed;
  result.program_version = OPPONENS_VERSION;
  return result;
}

void say_superseded(const Console& console, int superseded) {
  if (superseded == 0) return;
  console.say(std::to_string(superseded) + " recordings are superseded by newer ones of the same source and name");
}

MotionEntries newest_motions(const storage::Store& store, const char* kind) {
  const auto entries = store.list(kind);
  std::map<std::string, int> uses;  // of a name
  for (const auto& entry : entries) ++uses[entry.name];
  MotionEntries motions;
  if (uses.size() == entries.size()) {
    motions.newest = entries;
    return motions;
  }
  std::map<std::string, std::size_t> age;  // by id, larger is newer
  for (const auto& entry : store.list_as_produced(kind)) age.emplace(entry.id, age.size());
  std::map<std::pair<std::string, std::string>, std::size_t> places;  // source and recording -> place in newest
  for (const auto& entry : entries) {
    if (uses.at(entry.name) > 1) {
      const auto [place, first] = places.try_emplace({source_of(store, entry), entry.name}, motions.newest.size());
      if (!first) {
        ++motions.superseded;
        storage::IndexEntry& other = motions.newest[place->second];
        if (age.at(entry.id) > age.at(other.id)) other = entry;
        continue;
      }
    }
    motions.newest.push_back(entry);
  }
  return motions;
}

Motions recordings(const storage::Store& store) { return motions_of(store, kRecording); }

Motions hand_motions(const storage::Store& store) { return motions_of(store, kHandMotion); }

std::optional<std::string> newest(const storage::Store& store, const char* kind) {
  const auto entries = store.list_as_produced(kind);
  return entries.empty() ? std::nullopt : std::optional(entries.back().id);
}

std::vector<storage::IndexEntry> made_from(const storage::Store& store, const char* kind,
                                           const std::set<std::string>& inputs) {
  auto entries = store.list_as_produced(kind);
  std::erase_if(entries, [&](const storage::IndexEntry& entry) {
    return std::none_of(entry.inputs.begin(), entry.inputs.end(), [&](const auto& id) { return inputs.contains(id); });
  });
  std::reverse(entries.begin(), entries.end());
  return entries;
}

Stored<SynergySet> synergies_of(const storage::Store& store, const std::string& id) {
  storage::Record record = store.read(id);
  if (record.kind != kSynergySet && record.kind != kFirstOrderSynergies) {
    throw InputError(id + ": is a " + record.kind + ", no synergy set");
  }
  SynergySet value = storage::decode_synergy_set(record);
  return {store.find(id).id, std::move(record), std::move(value)};
}

std::vector<const SynergyGroup*> groups_in_order(const SynergySet& set) {
  std::vector<const SynergyGroup*> groups = {&set.pre_grasp};
  for (const auto& group : set.grasp) groups.push_back(&group);
  return groups;
}

Stored<SynergySet> newest_synergies(const storage::Store& store) {
  const auto id = newest(store, kSynergySet);
  if (!id) throw InputError(store.directory().string() + ": no synergies yet; run: opponens analyze");
  return synergies_of(store, *id);
}

const SynergyGroup& group_named(const SynergySet& set, const std::string& name) {
  const auto found =
      std::find_if(set.grasp.begin(), set.grasp.end(), [&](const SynergyGroup& group) { return group.name == name; });
  if (found == set.grasp.end()) throw InputError("a stored grasp's synergies have no group " + name);
  return *found;
}

std::string recorded_arm(const std::string& robot) {
  const std::size_t hash = robot.rfind('#');
  // No arm has a slash in its name: this # is a folder's.
  return hash == std::string::npos || robot.find('/', hash) != std::string::npos ? "" : robot.substr(hash + 1);
}

std::vector<WorldKey> world_keys(const storage::Record& record) {
  const nlohmann::json world = parameters_of(record).at("world");
  std::set<std::string> files;
  for (const auto& [name, hash] : record.provenance.files) files.insert(hash);
  if (!world.contains("objects")) return {{world.at("object"), recorded_arm(world.at("robot")), std::move(files)}};
  std::vector<WorldKey> keys;
  for (const auto& [arm, object] : world.at("objects").items()) keys.push_back({object, arm, files});
  return keys;
}

WorldKey key_of_arm(const storage::Record& record, const std::string& arm) {
  for (auto& key : world_keys(record)) {
    if (key.arm == arm) return key;
  }
  throw InputError(record.kind + " '" + record.name + "' is not about arm '" + arm + "', though its robot is");
}

std::vector<Stored<Grasp>> grasps_of(const storage::Store& store, const std::string& synergies, const WorldKey& world) {
  std::vector<Stored<Grasp>> result;
  for (const auto& entry : store.list(kGrasp)) {
    if (std::find(entry.inputs.begin(), entry.inputs.end(), synergies) == entry.inputs.end()) continue;
    storage::Record record = store.read(entry.id);
    if (world_keys(record) != std::vector{world}) continue;
    Grasp value = storage::decode_grasp(record);
    result.push_back({entry.id, std::move(record), std::move(value)});
  }
  return result;
}

nlohmann::json parameters_of(const storage::Record& record) {
  return nlohmann::json::parse(record.provenance.parameters);
}

std::string goal_grasp_field(const std::string& arm) { return "goal_grasp." + arm; }

std::string text_field(const storage::Record& record, const std::string& name) {
  const auto found = record.fields.find(name);
  const auto* text = found == record.fields.end() ? nullptr : std::get_if<std::string>(&found->second);
  return text == nullptr ? std::string() : *text;
}

RunLog::RunLog(const storage::Store& store, std::string command, int threads)
    : store_(store), command_(std::move(command)), threads_(threads), wall_begin_(wall_now()), cpu_begin_(cpu_now()) {}

double RunLog::cpu_seconds() const { return cpu_now() - cpu_begin_; }

void RunLog::finish(const std::vector<std::string>& stored) const { finish(stored, nlohmann::json::object()); }

void RunLog::finish(const std::vector<std::string>& stored, const nlohmann::json& more) const {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  nlohmann::json line = {{"command", command_},
                         {"date", utc_date(wall_begin_)},
                         {"wall_seconds", wall_now() - wall_begin_},
                         {"cpu_seconds", cpu_seconds()},
                         {"host", host.data()},
                         {"threads", threads_},
                         {"program_version", OPPONENS_VERSION},
                         {"stored", stored.size()},
                         {"first", stored.empty() ? "" : stored.front()}};
  line.update(more);
  store_.log_run(line.dump());
}

int thread_count(int option) {
  return option > 0 ? option : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace opponens::cli
