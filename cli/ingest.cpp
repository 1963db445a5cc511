// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "storage/codec.hpp"
#include "storage/readers/source.hpp"

namespace opponens::cli {
namespace {

Json summary_json(const storage::Summary& summary) {
  Json channels = Json::array();
  for (const auto& channel : summary.channels) {
    channels.push_back({{"name", channel.name},
                        {"min_rad", number(channel.min)},
                        {"max_rad", number(channel.max)},
                        {"recordings", channel.recordings},
                        {"stuck_recordings", channel.stuck_recordings}});
  }
  return {{"recordings", summary.recordings},
          {"samples", summary.samples},
          {"duration_s", summary.duration},
          {"lowest_rate_hz", number(summary.lowest_rate)},
          {"highest_rate_hz", number(summary.highest_rate)},
          {"channels", channels},
          {"labels", summary.recordings_per_label}};
}

void say_summary(const Console& console, const storage::Summary& summary) {
  char text[160];
  std::snprintf(text, sizeof text, "%d recordings, %lld samples, %.1f s, %.0f to %.0f Hz", summary.recordings,
                static_cast<long long>(summary.samples), summary.duration, summary.lowest_rate, summary.highest_rate);
  console.say(text);
  for (const auto& [label, values] : summary.recordings_per_label) {
    std::string line = "  " + label + ":";
    for (const auto& [value, count] : values) line += " " + value + " (" + std::to_string(count) + ")";
    console.say(line);
  }
  for (const auto& channel : summary.channels) {
    std::snprintf(text, sizeof text, "  %-12s %7.2f to %6.2f rad%s", channel.name.c_str(), channel.min, channel.max,
                  channel.stuck_recordings > 0
                      ? ("  stuck in " + std::to_string(channel.stuck_recordings) + " recordings").c_str()
                      : "");
    console.say(text);
  }
}

storage::Record recording_record(const Demonstration& motion, const storage::FileReport& file,
                                 const std::filesystem::path& source) {
  auto origin = provenance(
      "ingest", {}, {},
      {{"rows", file.rows}, {"trimmed_start_s", file.trimmed_start}, {"trimmed_end_s", file.trimmed_end}}, 0);
  origin.files[portable_name(source)] = file_sha256(source);
  origin.files[file.index] = file.index_sha256;
  origin.files[file.file.filename().string()] = file.sha256;
  return storage::encode(motion, origin);
}

}  // namespace

int ingest(const IngestOptions& options, const Console& console) {
  if (options.source.empty()) return ingest_single_files(options, console);
  const auto source_file = find_file(options.source);
  const auto source = storage::load_source(source_file);
  const auto reading = storage::read_source(options.paths, source);
  const auto summary = storage::summarize(reading.demonstrations);
  Json result = document("ingest");
  result["summary"] = summary_json(summary);
  result["stored"] = !options.dry_run;
  if (!options.dry_run) {
    storage::Store store(options.common.store, true);
    const RunLog log(store, "ingest", 1);
    std::vector<storage::Record> records;
    for (std::size_t i = 0; i < reading.demonstrations.size(); ++i) {
      records.push_back(recording_record(reading.demonstrations[i], reading.files[i], source_file));
    }
    const auto ids = store.commit(records);
    log.finish(ids);
    result["ids"] = ids;
  }
  say_summary(console, summary);
  console.say(options.dry_run ? "dry run: nothing was stored" : "stored in " + options.common.store.string());
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
