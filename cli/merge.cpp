// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "storage/single_file.hpp"

namespace opponens::cli {
namespace {

void require_another(const std::filesystem::path& from, const std::filesystem::path& target) {
  std::error_code error;
  if (std::filesystem::equivalent(from, target, error)) {
    throw InputError(from.string() + ": is the store to merge into; name others");
  }
}

}  // namespace

int merge(const MergeOptions& options, const Console& console) {
  std::vector<storage::Store> sources;
  for (const auto& path : options.stores) {
    require_another(path, options.common.store);
    sources.emplace_back(path, false);
    sources.back().list();  // one that lacks files is refused before anything is written
  }
  storage::Store target(options.common.store, true);
  const RunLog log(target, "merge", 1);
  std::vector<std::string> all;
  Json parts = Json::array();
  for (const auto& source : sources) {
    Progress progress(console, "merge " + source.directory().string());
    const std::vector<std::string> ids = storage::merge_store(source, target, progress.counter());
    const std::size_t objects = source.list().size();
    console.say(source.directory().string() + ": " + std::to_string(ids.size()) + " of " + std::to_string(objects) +
                " objects were new");
    parts.push_back({{"store", source.directory().string()}, {"objects", objects}, {"new", ids.size()}});
    all.insert(all.end(), ids.begin(), ids.end());
  }
  log.finish(all);
  Json result = document("merge");
  result["stores"] = parts;
  result["ids"] = all;
  result["objects"] = target.list().size();
  console.document(result.dump());
  return kDone;
}

int ingest_single_files(const IngestOptions& options, const Console& console) {
  for (const auto& path : options.paths) {
    if (storage::is_single_file(path)) continue;
    throw InputError(path.string() +
                     ": --source is missing: expected a YAML that describes the recordings (docs/ingest.md); only what "
                     "opponens export --single-file wrote needs none (is it cut off?)");
  }
  if (options.dry_run)
    throw InputError("--dry-run is for recordings; show what a file holds by ingesting it elsewhere");
  storage::Store store(options.common.store, true);
  const RunLog log(store, "ingest", 1);
  const std::size_t before = store.list().size();
  std::vector<std::string> ids;
  for (const auto& path : options.paths) {
    Progress progress(console, "ingest " + path.string());
    const auto taken = storage::import_single_file(path, store, progress.counter());
    ids.insert(ids.end(), taken.begin(), taken.end());
  }
  log.finish(ids);
  const std::size_t added = store.list().size() - before;
  console.say(std::to_string(ids.size()) + " objects read, " + std::to_string(added) + " of them new");
  Json result = document("ingest");
  result["stored"] = true;
  result["ids"] = ids;
  result["new"] = added;
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
