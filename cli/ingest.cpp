// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <optional>

#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/json.hpp"
#include "cli/resources.hpp"
#include "cli/stored.hpp"
#include "core/require.hpp"
#include "storage/codec.hpp"
#include "storage/readers/source.hpp"

namespace opponens::cli {
namespace {

/// A batch is committed when it has this many recordings or this many bytes of samples: what a kill can cost.
constexpr std::size_t kBatchRecordings = 256;
constexpr std::size_t kBatchBytes = std::size_t{32} << 20;

Json summary_json(const storage::Summary& summary) {
  Json channels = Json::array();
  for (const auto& channel : summary.channels) {
    channels.push_back({{"name", channel.name},
                        {"unit", "rad"},
                        {"min_rad", number(channel.min)},
                        {"max_rad", number(channel.max)},
                        {"recordings", channel.recordings},
                        {"stuck_recordings", channel.stuck_recordings},
                        {"depends_on", Json::array()}});
  }
  for (const auto& dependent : storage::dependent_channels(summary)) {
    for (auto& channel : channels) {
      if (channel["name"] == dependent.name) channel["depends_on"] = dependent.of;
    }
  }
  return {{"recordings", summary.recordings},
          {"samples", summary.samples},
          {"duration_s", summary.duration},
          {"lowest_rate_hz", number(summary.lowest_rate)},
          {"highest_rate_hz", number(summary.highest_rate)},
          {"largest_step_s", summary.largest_step},
          {"gaps", summary.gaps},
          {"channels", channels},
          {"labels", summary.recordings_per_label}};
}

/// Channels of the description that no recording has.
std::vector<std::string> dropped_channels(const storage::Summary& summary, const storage::SourceDescription& source) {
  std::vector<std::string> dropped;
  for (const auto& channel : source.channels) {
    const bool there = std::any_of(summary.channels.begin(), summary.channels.end(),
                                   [&](const auto& one) { return one.name == channel.joint; });
    if (!there) dropped.push_back(channel.joint);
  }
  return dropped;
}

void say_channels(const Console& console, const storage::Summary& summary) {
  const auto dependent = storage::dependent_channels(summary);
  char text[160];
  for (const auto& channel : summary.channels) {
    std::snprintf(text, sizeof text, "  %-12s %7.2f to %6.2f rad", channel.name.c_str(), channel.min, channel.max);
    std::string line = text;
    if (channel.stuck_recordings > 0) line += "  stuck in " + std::to_string(channel.stuck_recordings) + " recordings";
    for (const auto& one : dependent) {
      if (one.name == channel.name) line += "  linear in " + joined(one.of);
    }
    console.say(line);
  }
}

void say_summary(const Console& console, const storage::Summary& summary, bool postures) {
  char text[200];
  const auto samples = static_cast<long long>(summary.samples);
  if (postures) {
    std::snprintf(text, sizeof text, "%d sets of postures, %lld samples, no time", summary.recordings, samples);
    console.say(text);
  } else {
    std::snprintf(text, sizeof text, "%d recordings, %lld samples, %.1f s, %.0f to %.0f Hz", summary.recordings,
                  samples, summary.duration, summary.lowest_rate, summary.highest_rate);
    console.say(text);
    std::snprintf(text, sizeof text,
                  "  %d gaps (steps above 3 times the median step of their file), longest step %.3f s", summary.gaps,
                  summary.largest_step);
    console.say(text);
  }
  for (const auto& [label, values] : summary.recordings_per_label) {
    constexpr int kShown = 12;
    std::string line = "  " + label + ":";
    int shown = 0;
    for (const auto& [value, count] : values) {
      if (++shown <= kShown) line += " " + value + " (" + std::to_string(count) + ")";
    }
    if (shown > kShown) line += " and " + std::to_string(shown - kShown) + " more";
    console.say(line);
  }
  say_channels(console, summary);
}

storage::Record recording_record(const storage::Recording& recording, const storage::SourceDescription& source,
                                 const std::string& source_name, const std::string& source_sha256) {
  const storage::FileReport& file = recording.file;
  Json parameters = {{"rows", file.rows}, {"trimmed_start_s", file.trimmed_start}, {"trimmed_end_s", file.trimmed_end}};
  const bool hand = source.kind == storage::RecordingKind::hand_demonstration;
  if (hand) parameters["hand"] = source.hand;
  auto origin = provenance("ingest", {}, {}, parameters, 0);
  origin.files[source_name] = source_sha256;
  origin.files.insert(file.companions.begin(), file.companions.end());
  origin.files[file.file.filename().string()] = file.sha256;
  auto record = storage::encode(recording.demonstration, origin);
  if (hand) record.kind = kHandMotion;
  return record;
}

/// Collects records and commits them batch by batch; what is committed is said at once.
class BatchWriter {
 public:
  BatchWriter(const std::filesystem::path& store, const Console& console) : path_(store), console_(console) {}

  void add(storage::Record&& record, std::size_t bytes) {
    records_.push_back(std::move(record));
    bytes_ += bytes;
    if (records_.size() >= kBatchRecordings || bytes_ >= kBatchBytes) commit();
  }

  void commit() {
    if (records_.empty()) return;
    open();
    const auto ids = store_->commit(records_);
    ids_.insert(ids_.end(), ids.begin(), ids.end());
    const std::string line =
        "committed " + std::to_string(ids.size()) + " recordings (" + std::to_string(ids_.size()) + " so far)";
    console_.say(line);
    if (console_.json()) console_.advise(line);  // stdout is for the document
    std::fflush(stdout);
    records_.clear();
    bytes_ = 0;
  }

  /// Ends the run: what is not committed is dropped when the user interrupted.
  std::vector<std::string> finish() {
    if (!interrupt_requested) commit();
    if (log_) log_->finish(ids_);
    if (interrupt_requested) throw Interrupted();
    return ids_;
  }

 private:
  /// At the first commit: input that cannot be read leaves no store behind.
  void open() {
    if (store_) return;
    store_.emplace(path_, true);
    log_.emplace(*store_, "ingest", 1);
  }

  std::filesystem::path path_;
  const Console& console_;
  std::optional<storage::Store> store_;
  std::optional<RunLog> log_;
  std::vector<storage::Record> records_;
  std::size_t bytes_ = 0;
  std::vector<std::string> ids_;
};

/// Thrown out of the reader to end it early.
struct Stop {};

}  // namespace

int ingest(const IngestOptions& options, const Console& console) {
  if (options.source.empty()) return ingest_single_files(options, console);
  const auto source_file = find_file(options.source);
  const auto source = storage::load_source(source_file);
  const std::string source_sha256 = file_sha256(source_file);
  const std::string source_name = portable_name(source_file);
  storage::Summary summary;
  BatchWriter writer(options.common.store, console);
  try {
    storage::read_source(options.paths, source, [&](storage::Recording&& recording) {
      if (interrupt_requested) throw Stop();
      storage::add(summary, recording);
      if (options.dry_run) return;
      const std::size_t bytes = sizeof(double) * static_cast<std::size_t>(recording.demonstration.q_h.size());
      writer.add(recording_record(recording, source, source_name, source_sha256), bytes);
    });
  } catch (const Stop&) {
  }
  Json result = document("ingest");
  result["summary"] = summary_json(summary);
  const auto dropped = dropped_channels(summary, source);
  result["summary"]["dropped_channels"] = dropped;
  result["stored"] = !options.dry_run;
  if (!options.dry_run) result["ids"] = writer.finish();
  if (interrupt_requested) throw Interrupted();
  say_summary(console, summary, !source.time.present());
  if (!dropped.empty()) console.say("  dropped, as the source YAML asks: " + joined(dropped));
  console.say(options.dry_run ? "dry run: nothing was stored" : "stored in " + options.common.store.string());
  console.document(result.dump());
  return kDone;
}

}  // namespace opponens::cli
