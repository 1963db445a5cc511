// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
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

std::vector<Table> read_foreign(const fs::path& file, const SourceDescription& source) {
  const bool matlab = source.table.format == TableFormat::matlab;
  const auto work = [&] {
    return to_bytes(matlab ? read_matlab_tables(file, source) : read_hdf5_tables(file, source));
  };
  const char* kind = matlab ? "MATLAB" : "HDF5";
  const auto read = [&](int memory_fill) {
    ChildLimits limits;
    limits.memory_fill = memory_fill;
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

void read_file_tables(RecordingFile file, const SourceDescription& source, const TakeFile& take) {
  const std::string bytes = read_file(file.file);
  const std::string hash = sha256(bytes);
  if (!source.time.file.empty()) {
    file.companions[source.time.file] = sha256(read_file(file.file.parent_path() / source.time.file));
  }
  const auto take_table = [&](const Table& table) { take(table, file, hash); };
  if (source.table.format == TableFormat::csv || source.table.format == TableFormat::text) {
    read_text_tables(bytes, file.file, source, take_table);
  } else {
    for (const auto& table : read_foreign(file.file, source)) take_table(table);
  }
}

void read_paths(const std::vector<fs::path>& paths, const SourceDescription& source, const TakeFile& take) {
  std::set<std::string> ids;
  for (const auto& path : paths) {
    for (const auto& file : find_recordings(path, source)) {
      if (!ids.insert(file.id).second) {
        const bool index = !file.index.empty();
        throw_input(index ? file.index : file.file, file.line, "recording", file.id, "each recording once");
      }
      read_file_tables(file, source, take);
    }
  }
}

/// What a first reading of all recordings has found, in the unit of the files: neither standing still nor depending
/// on other channels changes with unit, sign or calibration.
struct Observations {
  std::vector<Pair> range;  // of the recordings that calibrate
  Summary summary;
  bool calibrates = false;
};

void observe(const Table& table, const RecordingFile& file, const SourceDescription& source, Observations& seen) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto rows = static_cast<Eigen::Index>(table.rows());
  const auto channels = static_cast<Eigen::Index>(source.channels.size());
  const Eigen::Map<const Rows> values(table.values.data(), rows, static_cast<Eigen::Index>(table.width));
  Recording recording;
  recording.demonstration.q_h = values.rightCols(channels);
  for (const auto& channel : source.channels) recording.demonstration.joint_names.push_back(channel.joint);
  add(seen.summary, recording);
  const auto labels = labels_of(table, file, source);
  const bool calibrates =
      std::all_of(source.raw_range.observed_in.begin(), source.raw_range.observed_in.end(), [&](const auto& wanted) {
        const auto found = labels.find(wanted.first);
        return found != labels.end() && found->second == wanted.second;
      });
  if (!calibrates || rows == 0) return;
  seen.calibrates = true;
  for (Eigen::Index j = 0; j < channels; ++j) {
    Pair& range = seen.range[static_cast<std::size_t>(j)];
    range[0] = std::min(range[0], recording.demonstration.q_h.col(j).minCoeff());
    range[1] = std::max(range[1], recording.demonstration.q_h.col(j).maxCoeff());
  }
}

bool is_observed(const ChannelSource& channel, const SourceDescription& source) {
  return source.unit == AngleUnit::raw && !channel.raw && !source.raw_range.fixed;
}

/// Reads everything once beforehand when the description asks for what only all recordings together can tell.
Survey survey_of(const std::vector<fs::path>& paths, const SourceDescription& source) {
  const std::size_t count = source.channels.size();
  Survey survey{std::vector<Pair>(count, source.raw_range.fixed.value_or(Pair{0.0, 1.0})), {}};
  const bool ranges = std::any_of(source.channels.begin(), source.channels.end(),
                                  [&](const auto& channel) { return is_observed(channel, source); });
  const bool drops = source.stuck == ChannelRule::drop || source.dependent == ChannelRule::drop;
  std::set<std::string> dropped;
  if (ranges || drops) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Observations seen{std::vector<Pair>(count, Pair{kInfinity, -kInfinity}), {}, false};
    read_paths(paths, source, [&](const Table& table, const RecordingFile& file, const std::string&) {
      observe(table, file, source, seen);
    });
    if (ranges && !seen.calibrates) {
      throw InputError(source.name + ": no recording has the labels of raw_range.observed_in: expected at least one");
    }
    if (ranges) survey.raw = seen.range;
    for (const auto& channel : seen.summary.channels) {
      const bool stuck = channel.stuck_recordings == channel.recordings;
      if (stuck && source.stuck == ChannelRule::drop) dropped.insert(channel.name);
    }
    if (source.dependent == ChannelRule::drop) {
      for (const auto& channel : dependent_channels(seen.summary)) dropped.insert(channel.name);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!dropped.contains(source.channels[i].joint)) survey.kept.push_back(i);
  }
  if (survey.kept.empty()) throw InputError(source.name + ": every channel is stuck: expected one that moves");
  return survey;
}

}  // namespace

void read_source(const std::vector<fs::path>& paths, const SourceDescription& source, const TakeRecording& take) {
  const Survey survey = survey_of(paths, source);
  std::set<std::string> ids;
  const auto take_new = [&](Recording&& recording) {
    // "a_1" of a file with trials may meet the file "a_1".
    if (!ids.insert(recording.demonstration.id).second) {
      throw_input(recording.file.file, 0, "recording", recording.demonstration.id, "each recording once");
    }
    take(std::move(recording));
  };
  read_paths(paths, source, [&](const Table& table, const RecordingFile& file, const std::string& hash) {
    interpret(table, file, hash, source, survey, take_new);
  });
}

std::vector<Recording> read_source(const std::vector<fs::path>& paths, const SourceDescription& source) {
  std::vector<Recording> recordings;
  read_source(paths, source, [&](Recording&& recording) { recordings.push_back(std::move(recording)); });
  return recordings;
}

}  // namespace opponens::storage
