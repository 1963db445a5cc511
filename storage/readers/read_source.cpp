// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/readers/child_process.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/find_recordings.hpp"
#include "storage/readers/interpret.hpp"
#include "storage/readers/source.hpp"
#include "storage/readers/table.hpp"
#include "storage/sha256.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

using TakeFile = std::function<void(const Table&, const RecordingFile&, const std::string& sha256)>;

std::vector<Table> read_foreign(const fs::path& file, const SourceDescription& source,
                                const std::function<bool()>& interrupted) {
  const bool matlab = source.table.format == TableFormat::matlab;
  const auto work = [&] {
    return to_bytes(matlab ? read_matlab_tables(file, source) : read_hdf5_tables(file, source));
  };
  const char* kind = matlab ? "MATLAB" : "HDF5";
  const auto read = [&](int memory_fill) {
    ChildLimits limits;
    limits.memory_fill = memory_fill;
    limits.interrupted = interrupted;
    return run_limited(file, kind, work, limits);
  };
  // A damaged file can make a library hand out memory that it never read into: then a second reading differs.
  const std::string bytes = read(0x55);
  if (read(0x2B) != bytes) {
    throw InputError(file.string() + ": the reader of " + kind +
                     " files gives other values when it reads again: the file is damaged");
  }
  return from_bytes(bytes, file, source);
}

/// Block by block: files that a child reads may be larger than what this process should hold.
std::string hash_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Sha256 hash;
  std::string block(1 << 20, '\0');
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.update(std::string_view(block).substr(0, static_cast<std::size_t>(stream.gcount())));
  }
  if (!stream.eof()) throw InputError(file.string() + ": cannot read it");
  return hash.hex();
}

/// The recordings that PATHs lead to, and whether the user wants to wait for them.
struct Reading {
  const std::vector<fs::path>& paths;
  const SourceDescription& source;
  const std::function<bool()>& interrupted;
};

void read_file_tables(RecordingFile file, const Reading& reading, const TakeFile& take) {
  const SourceDescription& source = reading.source;
  if (!source.time.file.empty()) {
    file.companions[source.time.file] = hash_of(file.file.parent_path() / source.time.file);
  }
  if (source.table.format == TableFormat::csv || source.table.format == TableFormat::text) {
    const std::string bytes = read_file(file.file);
    const std::string hash = sha256(bytes);
    read_text_tables(bytes, file.file, source, [&](const Table& table) { take(table, file, hash); });
  } else {
    const std::string hash = hash_of(file.file);
    for (const auto& table : read_foreign(file.file, source, reading.interrupted)) take(table, file, hash);
  }
}

void read_paths(const Reading& reading, const TakeFile& take) {
  std::set<std::string> ids;
  for (const auto& path : reading.paths) {
    for (const auto& file : find_recordings(path, reading.source)) {
      if (reading.interrupted && reading.interrupted()) throw ReadingInterrupted();
      if (!ids.insert(file.id).second) {
        const bool index = !file.index.empty();
        throw_input(index ? file.index : file.file, file.line, "recording", file.id, "each recording once");
      }
      read_file_tables(file, reading, take);
    }
  }
}

bool is_observed(const ChannelSource& channel, const SourceDescription& source) {
  return source.unit == AngleUnit::raw && !channel.raw && !source.raw_range.fixed;
}

/// The least and largest counts of the recordings that calibrate, and what they were.
struct Calibration {
  std::vector<Pair> range;
  std::map<std::string, std::string> files;  // name -> SHA-256
  std::set<std::string> hashes;
};

void observe(const Table& table, const RecordingFile& file, const std::string& hash, const SourceDescription& source,
             Calibration& seen) {
  const auto labels = labels_of(table, file, source);
  const bool calibrates =
      std::all_of(source.raw_range.observed_in.begin(), source.raw_range.observed_in.end(), [&](const auto& wanted) {
        const auto found = labels.find(wanted.first);
        return found != labels.end() && found->second == wanted.second;
      });
  if (!calibrates || table.rows() == 0) return;
  seen.files[file.file.filename().string()] = hash;
  seen.hashes.insert(hash);
  const std::size_t first = time_width(source);
  for (std::size_t i = 0; i < table.values.size(); i += table.width) {
    for (std::size_t j = 0; j < seen.range.size(); ++j) {
      const double count = table.values[i + first + j];
      seen.range[j] = {std::min(seen.range[j][0], count), std::max(seen.range[j][1], count)};
    }
  }
}

/// What every recording tells of the survey that it was read with (FileReport).
FileReport made_with(const Survey& survey, const Calibration& seen, const SourceDescription& source) {
  FileReport report;
  std::size_t next = 0;
  for (std::size_t i = 0; i < source.channels.size(); ++i) {
    const ChannelSource& channel = source.channels[i];
    if (next == survey.kept.size() || survey.kept[next] != i) {
      report.dropped.push_back(channel.joint);
      continue;
    }
    ++next;
    if (is_observed(channel, source)) report.observed_range[channel.joint] = survey.raw[i];
  }
  if (seen.hashes.empty()) return report;
  constexpr std::size_t kListed = 16;  // more are not worth a list in each of their recordings
  if (seen.hashes.size() <= kListed) report.companions = seen.files;
  Sha256 all;
  for (const auto& hash : seen.hashes) all.update(hash);
  report.calibrated_by = all.hex();
  return report;
}

/// Channels to leave out, by what the recordings become with all of them.
std::set<std::string> dropped_channels(const Reading& reading, const Survey& survey) {
  const SourceDescription& source = reading.source;
  Summary summary;
  read_paths(reading, [&](const Table& table, const RecordingFile& file, const std::string& hash) {
    interpret(table, file, hash, source, survey, [&](Recording&& recording) { add(summary, recording); });
  });
  std::set<std::string> dropped;
  for (const auto& channel : summary.channels) {
    const bool stuck = channel.stuck_recordings == channel.recordings;
    if (stuck && source.stuck == ChannelRule::drop) dropped.insert(channel.name);
  }
  if (source.dependent == ChannelRule::drop) {
    for (const auto& channel : dependent_channels(summary)) dropped.insert(channel.name);
  }
  return dropped;
}

/// Reads everything beforehand when the description asks for what only all recordings together can tell: once for the
/// counts, once, with these, for what the channels do.
Survey survey_of(const Reading& reading, Calibration& seen) {
  const SourceDescription& source = reading.source;
  const std::size_t count = source.channels.size();
  Survey survey{std::vector<Pair>(count, source.raw_range.fixed.value_or(Pair{0.0, 1.0})), {}};
  for (std::size_t i = 0; i < count; ++i) survey.kept.push_back(i);
  if (std::any_of(source.channels.begin(), source.channels.end(),
                  [&](const auto& channel) { return is_observed(channel, source); })) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    seen.range.assign(count, Pair{kInfinity, -kInfinity});
    read_paths(reading, [&](const Table& table, const RecordingFile& file, const std::string& hash) {
      observe(table, file, hash, source, seen);
    });
    if (seen.hashes.empty()) {
      throw InputError(source.name + ": no recording has the labels of raw_range.observed_in: expected at least one");
    }
    survey.raw = seen.range;
  }
  if (source.stuck != ChannelRule::drop && source.dependent != ChannelRule::drop) return survey;
  const std::set<std::string> dropped = dropped_channels(reading, survey);
  std::erase_if(survey.kept, [&](std::size_t i) { return dropped.contains(source.channels[i].joint); });
  if (survey.kept.empty()) throw InputError(source.name + ": every channel is stuck: expected one that moves");
  return survey;
}

}  // namespace

void read_source(const std::vector<fs::path>& paths, const SourceDescription& source, const TakeRecording& take,
                 const std::function<bool()>& interrupted) {
  const Reading reading{paths, source, interrupted};
  Calibration seen;
  const Survey survey = survey_of(reading, seen);
  const FileReport common = made_with(survey, seen, source);
  std::set<std::string> ids;
  const auto take_new = [&](Recording&& recording) {
    // "a_1" of a file with trials may meet the file "a_1".
    if (!ids.insert(recording.demonstration.id).second) {
      throw_input(recording.file.file, 0, "recording", recording.demonstration.id, "each recording once");
    }
    recording.file.observed_range = common.observed_range;
    recording.file.dropped = common.dropped;
    recording.file.calibrated_by = common.calibrated_by;
    recording.file.companions.insert(common.companions.begin(), common.companions.end());
    take(std::move(recording));
  };
  read_paths(reading, [&](const Table& table, const RecordingFile& file, const std::string& hash) {
    interpret(table, file, hash, source, survey, take_new);
  });
}

std::vector<Recording> read_source(const std::vector<fs::path>& paths, const SourceDescription& source) {
  std::vector<Recording> recordings;
  read_source(paths, source, [&](Recording&& recording) { recordings.push_back(std::move(recording)); });
  return recordings;
}

}  // namespace opponens::storage
