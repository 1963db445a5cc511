// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <set>
#include <span>
#include <unordered_set>

#include "cli/commands.hpp"
#include "cli/export_grasps.hpp"
#include "cli/export_table.hpp"
#include "cli/export_trajectory.hpp"
#include "cli/grasp_document.hpp"
#include "cli/json.hpp"
#include "cli/records.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/robomimic.hpp"
#include "storage/single_file.hpp"

namespace opponens::cli {
namespace {

namespace fs = std::filesystem;

/// The objects asked for: by id, by kind, or all.
std::vector<storage::IndexEntry> chosen(const storage::Store& store, const ExportOptions& options) {
  std::vector<storage::IndexEntry> entries = store.list_as_produced(options.kind);
  if (options.ids.empty()) {
    if (!entries.empty()) return entries;
    throw InputError(store.directory().string() + ": nothing to export" +
                     (options.kind.empty() ? "" : " of kind '" + options.kind + "'"));
  }
  std::unordered_set<std::string> wanted;
  for (const auto& id : options.ids) {
    const storage::IndexEntry entry = store.find(id);
    if (!options.kind.empty() && entry.kind != options.kind) {
      throw InputError("'" + id + "' is a " + entry.kind + ", not a " + options.kind + " (--kind)");
    }
    wanted.insert(entry.id);
  }
  std::erase_if(entries, [&](const auto& entry) { return !wanted.contains(entry.id); });
  return entries;
}

int export_file(const storage::Store& store, const ExportOptions& options, const Console& console) {
  std::vector<std::string> ids;
  for (const auto& entry : chosen(store, options)) ids.push_back(entry.id);
  const storage::Closure closure = storage::closure_of(store, ids);
  {
    Progress progress(console, "export");
    storage::export_single_file(store, closure.objects, options.single_file, progress.counter());
  }
  for (const auto& id : closure.missing) {
    console.advise("made from " + id + ", which is not in the store, so not in the file");
  }
  console.say(std::to_string(closure.objects.size()) + " objects in " + options.single_file.string() +
              "; taken back by: opponens ingest " + options.single_file.string() + " --store S");
  Json result = document("export");
  result["format"] = "single_file";
  result["out"] = options.single_file.string();
  result["asked_for"] = ids.size();
  result["ids"] = Json::array();
  for (const auto& entry : closure.objects) result["ids"].push_back(entry.id);
  result["missing"] = closure.missing;
  console.document(result.dump());
  return kDone;
}

void advise_unnamed(const Console& console, const std::string& id, const char* where) {
  console.advise("grasp " + short_id(id) +
                 ": the store does not hold the synergies that it was made from, which name its "
                 "joints; it is left out of " +
                 where);
}

/// The grasps among the objects in the form of `grasp --json`, which `grasp --import` reads; "object" when all are of
/// one.
void append_grasps(const storage::Store& store, const std::vector<storage::IndexEntry>& entries, const fs::path& file,
                   const Console& console) {
  GraspDocuments documents(store);
  std::set<std::string> objects;
  std::string separator = ",\"grasps\":[\n";
  for (const auto& entry : entries) {
    if (entry.kind != kGrasp) continue;
    const auto document = documents.of(entry.id, store.read(entry.id));
    if (!document) advise_unnamed(console, entry.id, "'grasps'");
    if (!document) continue;
    objects.insert(document->at("object").get<std::string>());
    storage::append_bytes(file, separator + document->dump());
    separator = ",\n";
  }
  if (objects.empty()) return;
  const std::string common = objects.size() == 1 ? ",\"object\":" + Json(*objects.begin()).dump() : "";
  storage::append_bytes(file, "\n]" + common);
}

/// One JSON document with everything that the objects hold, written object by object.
void export_json(const storage::Store& store, const std::vector<storage::IndexEntry>& entries,
                 const ExportOptions& options, const Console& console) {
  const storage::Draft draft(options.out);
  std::string text = "{\"schema\":" + std::to_string(kDocumentSchema) + ",\"command\":\"export\",\"objects\":[";
  storage::write_new_file(draft.path(), {}, storage::Durable::no);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") + record_json(entries[i].id, store.read(entries[i].id)).dump();
    storage::append_bytes(draft.path(), text);
    text.clear();
  }
  storage::append_bytes(draft.path(), text + "\n]");
  append_grasps(store, entries, draft.path(), console);
  storage::append_bytes(draft.path(), std::string("}\n"));
  draft.complete();
}

void export_robomimic(const storage::Store& store, const std::vector<storage::IndexEntry>& entries,
                      const ExportOptions& options, const Console&) {
  storage::RobomimicWriter writer(options.out);
  for (const auto& entry : entries) writer.add(episode_of(entry.id, store.read(entry.id)));
  writer.finish();
}

void export_csv(const storage::Store& store, const std::vector<storage::IndexEntry>& entries,
                const ExportOptions& options, const Console& console) {
  TableFolder folder(options.out);
  GraspDocuments documents(store);
  GraspTables grasps;
  for (const auto& entry : entries) {
    const storage::Record record = store.read(entry.id);
    if (entry.kind != kGrasp) {
      folder.add(entry.id, record);
    } else if (const auto document = documents.of(entry.id, record)) {
      grasps.add(*document);
    } else {
      advise_unnamed(console, entry.id, "the tables");
    }
  }
  grasps.write_to(folder);
  folder.finish();
}

/// Writes the one path among the objects; of several the user has to name one.
template <std::string (*form)(const NamedTrajectory&)>
void export_trajectory(const storage::Store& store, const std::vector<storage::IndexEntry>& entries,
                       const ExportOptions& options, const Console&) {
  if (entries.size() != 1) {
    throw InputError("--format " + options.format + " writes one path, and there are " +
                     std::to_string(entries.size()) + "; name one by its id (opponens show --kind path)");
  }
  const std::string text = form(trajectory_of(entries[0].id, store.read(entries[0].id), options.period));
  const storage::Draft draft(options.out);
  storage::write_new_file(draft.path(), std::as_bytes(std::span(text)), storage::Durable::no);
  draft.complete();
}

struct Format {
  std::set<std::string> kinds;  ///< empty: all
  std::function<void(const storage::Store&, const std::vector<storage::IndexEntry>&, const ExportOptions&,
                     const Console&)>
      write;
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> all{
      {"csv", {{kRecording, kHandMotion, kPath, kSynergySet, kGrasp}, export_csv}},
      {"json", {{}, export_json}},
      {"robomimic", {{kRecording, kHandMotion, kPath}, export_robomimic}},
      {"trajectory_csv", {{kPath}, export_trajectory<trajectory_csv>}},
      {"trajectory_json", {{kPath}, export_trajectory<joint_trajectory_json>}},
      {"trajectory_yaml", {{kPath}, export_trajectory<joint_trajectory_yaml>}}};
  return all;
}

int export_as(const storage::Store& store, const ExportOptions& options, const Console& console) {
  const Format& format = formats().at(options.format);
  std::vector<storage::IndexEntry> entries = chosen(store, options);
  const auto unfit = [&](const auto& entry) { return !format.kinds.empty() && !format.kinds.contains(entry.kind); };
  const auto first = std::find_if(entries.begin(), entries.end(), unfit);
  if (first != entries.end() && !(options.ids.empty() && options.kind.empty())) {
    throw InputError("'" + first->id + "' is a " + first->kind + ", which has no form in " + options.format +
                     "; --format json and --single-file hold every kind");
  }
  const std::size_t left_out = std::erase_if(entries, unfit);
  if (entries.empty()) throw InputError("the store holds nothing that has a form in " + options.format);
  format.write(store, entries, options, console);
  console.say(std::to_string(entries.size()) + " objects in " + options.out.string() +
              (left_out == 0 ? "" : "; " + std::to_string(left_out) + " of other kinds left out"));
  Json result = document("export");
  result["format"] = options.format;
  result["out"] = options.out.string();
  result["ids"] = Json::array();
  for (const auto& entry : entries) result["ids"].push_back(entry.id);
  result["left_out"] = left_out;
  console.document(result.dump());
  return kDone;
}

}  // namespace

int export_objects(const ExportOptions& options, const Console& console) {
  const bool as = !options.format.empty();
  if (as == !options.single_file.empty()) {
    throw InputError("one of --single-file FILE and --format csv|json|robomimic|trajectory_... is needed");
  }
  if (as && options.out.empty()) throw InputError("--format needs --out: the file (csv: the folder) to write");
  if (options.period > 0.0 && !options.format.starts_with("trajectory_")) {
    throw InputError("--period belongs to --format trajectory_csv, trajectory_json or trajectory_yaml");
  }
  if (!as && !options.out.empty()) throw InputError("--out belongs to --format; --single-file names its file itself");
  const storage::Store store(options.common.store, false);
  return as ? export_as(store, options, console) : export_file(store, options, console);
}

}  // namespace opponens::cli
