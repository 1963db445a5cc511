// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/records.hpp"
#include "cli/stored.hpp"
#include "storage/single_file.hpp"

namespace opponens::cli {
namespace {

int list_store(const storage::Store& store, const std::string& kind, const Console& console) {
  Json objects = Json::array();
  for (const auto& entry : store.list(kind)) {
    console.say(short_id(entry.id) + "  " + entry.kind + "  " + entry.name);
    if (!console.json()) continue;
    Json object = entry_json(entry);
    object["file"] = entry.file;
    objects.push_back(std::move(object));
  }
  Json result = document("show");
  result["objects"] = std::move(objects);
  console.document(result.dump());
  return kDone;
}

struct Step {
  std::string id;
  int depth = 0;
};

/// Depth first, each object once. By the index alone: the objects are read afterwards, in the order of the files.
std::vector<Step> chain_order(const std::unordered_map<std::string, const storage::IndexEntry*>& entries,
                              const std::string& id) {
  std::vector<Step> order;
  std::vector<Step> open{{id, 0}};
  std::unordered_set<std::string> seen;
  while (!open.empty()) {
    const Step step = std::move(open.back());
    open.pop_back();
    if (!seen.insert(step.id).second) continue;
    order.push_back(step);
    const auto found = entries.find(step.id);
    if (found == entries.end()) continue;
    const auto& inputs = found->second->inputs;
    for (auto input = inputs.rbegin(); input != inputs.rend(); ++input) open.push_back({*input, step.depth + 1});
  }
  return order;
}

struct Line {
  std::string text;
  Json json;
};

Line line_of(const std::string& id, const storage::Record& record) {
  const auto& origin = record.provenance;
  return {short_id(id) + "  " + record.kind + "  " + record.name + "  (" + origin.command + " " + origin.parameters +
              ", seed " + std::to_string(origin.seed) + ")",
          {{"id", id},
           {"kind", record.kind},
           {"name", record.name},
           {"command", origin.command},
           {"inputs", origin.inputs},
           {"files", origin.files}}};
}

}  // namespace

int show(const ShowOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  if (options.id.empty()) return list_store(store, options.kind, console);
  const std::string id = store.find(options.id).id;
  const auto record = store.read(id);
  if (!console.json()) {
    for (const auto& line : record_lines(id, record)) console.say(line);
    return kDone;
  }
  Json result = document("show");
  result["object"] = record_json(id, record);
  console.document(result.dump());
  return kDone;
}

int why(const ShowOptions& options, const Console& console) {
  const storage::Store store(options.common.store, false);
  const std::string id = store.find(options.id).id;
  const std::vector<storage::IndexEntry> all = store.list();
  std::unordered_map<std::string, const storage::IndexEntry*> entries;
  for (const auto& entry : all) entries.emplace(entry.id, &entry);
  const std::vector<Step> order = chain_order(entries, id);
  std::unordered_set<std::string> wanted;
  for (const auto& step : order) wanted.insert(step.id);
  std::unordered_map<std::string, Line> lines;
  for (const auto& entry : all) {
    if (wanted.contains(entry.id)) lines.emplace(entry.id, line_of(entry.id, store.read(entry.id)));
  }
  Json chain = Json::array();
  for (const auto& step : order) {
    const auto line = lines.find(step.id);
    const bool missing = line == lines.end();
    console.say(std::string(static_cast<std::size_t>(2 * step.depth), ' ') +
                (missing ? short_id(step.id) + "  is not in the store" : line->second.text));
    Json link = missing ? Json{{"id", step.id}, {"kind", nullptr}} : std::move(line->second.json);
    link["depth"] = step.depth;
    chain.push_back(std::move(link));
  }
  Json result = document("why");
  result["chain"] = std::move(chain);
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
