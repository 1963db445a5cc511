// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/repair.hpp"

#include <algorithm>
#include <functional>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/records.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"

namespace opponens::cli {
namespace {

Json entries_json(const std::vector<storage::IndexEntry>& entries) {
  Json list = Json::array();
  for (const auto& entry : entries) list.push_back(entry_json(entry));
  return list;
}

void say_file(const storage::DamagedFile& file, bool dry_run, const Console& console) {
  console.say(file.file + ": " + file.reason);
  for (const auto& entry : file.lost) {
    console.say("  lost    " + short_id(entry.id) + "  " + entry.kind + "  " + entry.name);
  }
  for (const auto& entry : file.saved) {
    console.say("  intact  " + short_id(entry.id) + "  " + entry.kind + "  " + entry.name);
  }
  if (file.unreadable) return console.say("  cannot be read, so it was left as it is");
  if (!file.index_knew_it) console.say("  the index does not know this file; it may have held more");
  if (!dry_run) {
    console.say(file.saved.empty() ? "  nothing in it is intact" : "  what is intact was written to a new file");
  }
}

}  // namespace

int repair(const RepairOptions& options, const Console& console) {
  { const storage::Store store(options.common.store, false); }  // says so when it is none, or of a newer schema
  const storage::RepairReport report = storage::repair(options.common.store, options.dry_run);
  Json files = Json::array();
  for (const auto& file : report.files) {
    say_file(file, options.dry_run, console);
    files.push_back({{"file", file.file},
                     {"reason", file.reason},
                     {"intact", entries_json(file.saved)},
                     {"lost", entries_json(file.lost)},
                     {"index_knew_it", file.index_knew_it},
                     {"unreadable", file.unreadable}});
  }
  Json dangling = Json::array();
  for (const auto& [object, input] : report.dangling) {
    console.say(short_id(object.id) + "  " + object.kind + "  " + object.name + ": made from " + short_id(input) +
                ", which is not in the store");
    Json item = entry_json(object);
    item["missing_input"] = input;
    dangling.push_back(std::move(item));
  }
  if (report.files.empty()) {
    console.say("nothing is damaged");
  } else if (!options.dry_run) {
    console.say("damaged files are in " + (options.common.store / storage::kDamagedFolder).string() +
                ", as far as they can be read; nothing was deleted");
    const storage::Store store(options.common.store, false);
    RunLog(store, "repair", 1).finish({});
  }
  Json result = document("repair");
  result["dry_run"] = options.dry_run;
  result["files"] = std::move(files);
  result["missing_upstream"] = std::move(dangling);
  console.document(result.dump());
  const bool unreadable =
      std::any_of(report.files.begin(), report.files.end(), std::mem_fn(&storage::DamagedFile::unreadable));
  return unreadable || (options.dry_run && !report.files.empty()) ? kStoreDamaged : kDone;
}

}  // namespace opponens::cli
