// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/stored.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

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

Stored<Demonstration> read_demonstration(const storage::Store& store, const std::string& id) {
  storage::Record record = store.read(id);
  Demonstration value = storage::decode_demonstration(record);
  return {id, std::move(record), std::move(value)};
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

std::vector<Stored<Demonstration>> recordings(const storage::Store& store) {
  std::vector<Stored<Demonstration>> result;
  for (const auto& entry : store.list(kRecording)) result.push_back(read_demonstration(store, entry.id));
  return result;
}

std::vector<Stored<Demonstration>> hand_motions(const storage::Store& store) {
  std::map<std::string, std::string> newest;  // recording id -> motion id
  std::vector<std::string> order;
  for (const auto& entry : store.list(kHandMotion)) {
    const std::string source = entry.inputs.empty() ? entry.id : entry.inputs.front();
    if (newest.insert_or_assign(source, entry.id).second) order.push_back(source);
  }
  std::vector<Stored<Demonstration>> result;
  for (const auto& source : order) result.push_back(read_demonstration(store, newest.at(source)));
  return result;
}

Stored<SynergySet> newest_synergies(const storage::Store& store) {
  const auto entries = store.list(kSynergySet);
  if (entries.empty()) throw InputError(store.directory().string() + ": no synergies yet; run: opponens analyze");
  storage::Record record = store.read(entries.back().id);
  SynergySet value = storage::decode_synergy_set(record);
  return {entries.back().id, std::move(record), std::move(value)};
}

const SynergyGroup& group_named(const SynergySet& set, const std::string& name) {
  const auto found =
      std::find_if(set.grasp.begin(), set.grasp.end(), [&](const SynergyGroup& group) { return group.name == name; });
  if (found == set.grasp.end()) throw InputError("a stored grasp's synergies have no group " + name);
  return *found;
}

std::vector<Stored<Grasp>> grasps_of(const storage::Store& store, const std::string& synergies,
                                     const nlohmann::json& world) {
  std::vector<Stored<Grasp>> result;
  for (const auto& entry : store.list(kGrasp)) {
    if (std::find(entry.inputs.begin(), entry.inputs.end(), synergies) == entry.inputs.end()) continue;
    storage::Record record = store.read(entry.id);
    const auto parameters = parameters_of(record);
    if (parameters.at("world") != world) continue;
    Grasp value = storage::decode_grasp(record);
    result.push_back({entry.id, std::move(record), std::move(value)});
  }
  return result;
}

nlohmann::json world_parameters(const std::string& robot, const std::string& scene, const std::string& object) {
  return {{"robot", recorded_name(find_file(robot))}, {"scene", recorded_name(find_file(scene))}, {"object", object}};
}

nlohmann::json parameters_of(const storage::Record& record) {
  return nlohmann::json::parse(record.provenance.parameters);
}

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
