// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/report_grasps.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "cli/grasp_causes.hpp"
#include "cli/json.hpp"

namespace opponens::cli {
namespace {

using report::GraspItem;
using report::GraspPart;
using report::GraspSearch;

void count_search(const Json& summary, GraspSearch& search) {
  search.trials += summary.at("trials").get<std::int64_t>();
  search.found += summary.at("found").get<std::int64_t>();
  for (const auto& [reason, count] : summary.at("rejected").items()) {
    search.rejected[reason] += count.get<std::int64_t>();
  }
}

/// What the searches of one synergy set in one world came to, in the order of the set's groups; then those of no group.
/// A search that was repeated with the same settings is one object; with others it counts beside the first.
std::vector<GraspSearch> grasp_searches(const storage::Store& store, const Stored<SynergySet>& synergies,
                                        const WorldKey& world, const robot::Scene& scene) {
  std::vector<GraspSearch> searches;
  for (const auto& group : synergies.value.grasp) {
    searches.emplace_back();
    searches.back().group = group.name;
  }
  std::set<std::string> made;
  for (const auto& entry : store.list(kGraspSearch)) {
    const auto record = store.read(entry.id);
    if (entry.inputs != std::vector<std::string>{synergies.id} || world_keys(record) != std::vector{world}) continue;
    auto found = std::find_if(searches.begin(), searches.end(),
                              [&](const GraspSearch& search) { return search.group == record.name; });
    if (found == searches.end()) {
      found = searches.insert(searches.end(), GraspSearch{});
      found->group = record.name;
      found->of_group = false;
    }
    made.insert(record.name);
    count_search(Json::parse(text_field(record, "summary")), *found);
  }
  std::erase_if(searches, [&](const GraspSearch& search) { return !made.contains(search.group); });
  for (auto& search : searches) {
    for (auto& cause : causes_of(search.rejected, scene, world.object)) {
      search.causes.push_back({std::move(cause.name), std::move(cause.advice), cause.trials});
    }
  }
  return searches;
}

}  // namespace

report::GraspPart report_grasps(const storage::Store& store, const Stored<SynergySet>& synergies, const WorldKey& world,
                                const robot::Scene& scene, const std::map<std::string, bool>& verdicts) {
  GraspPart part;
  part.object = world.object;
  part.grouped_by = parameters_of(synergies.record).at("group_by");
  for (auto& stored : grasps_of(store, synergies.id, world)) {
    const auto verdict = verdicts.find(stored.id);
    part.items.push_back({stored.id, std::move(stored.value),
                          verdict == verdicts.end() ? std::nullopt : std::optional<bool>(verdict->second)});
  }
  std::stable_sort(part.items.begin(), part.items.end(), [](const GraspItem& a, const GraspItem& b) {
    return a.grasp.quality.epsilon.value_or(-1.0) > b.grasp.quality.epsilon.value_or(-1.0);
  });
  part.searches = grasp_searches(store, synergies, world, scene);
  return part;
}

}  // namespace opponens::cli
