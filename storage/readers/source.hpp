// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/demonstration.hpp"

namespace opponens::storage {

/// The channels of a human hand that a source may map its columns to. rad; flexion positive; abduction positive away
/// from the middle finger (of the thumb: away from the palm; of the middle finger itself: towards the thumb).
const std::vector<std::string>& human_hand_channels();

/// One column of a recording and the channel it is: rad = sign * column (after conversion to rad).
struct ChannelSource {
  std::string column;
  std::string joint;
  double sign = 1.0;
};

/// Keeps the part of a recording between the first and the last time at which the hand moves: the largest
/// |q(t + window/2) - q(t - window/2)| / window over the channels is above speed.
struct TrimRule {
  double speed = 0.2;   ///< rad/s
  double window = 0.5;  ///< s; long enough that one step of a sensor is not a movement
};

enum class AngleUnit { rad, deg };

/// What a source YAML says (docs/ingest.md): how recordings of one origin are laid out and what their columns mean.
struct SourceDescription {
  std::string name;
  Origin origin = Origin::recorded;
  std::string index;                          ///< index file, relative to the directory given as PATH
  std::string folder;                         ///< folder of the recordings, relative to the same; may be empty
  std::string file_column;                    ///< column of the index that names a recording's file
  std::map<std::string, std::string> labels;  ///< label -> column of the index
  std::string time_column;                    ///< s
  AngleUnit unit = AngleUnit::rad;
  std::vector<ChannelSource> channels;
  std::vector<std::string> ignored_columns;  ///< columns that are there and not wanted
  std::optional<double> resample_rate;       ///< Hz
  std::optional<TrimRule> trim;
  std::optional<std::string> calibrate_by;  ///< zero unknown: calibrate range to range per value of this label
};

/// Throws InputError naming file, line, field, value and expectation.
SourceDescription load_source(const std::filesystem::path& yaml);

/// What was found in one file and what was done to it.
struct FileReport {
  std::filesystem::path file;
  std::string id;              ///< of its demonstration
  std::string sha256;          ///< of the file's bytes
  std::string index;           ///< name of the index file that gave its labels
  std::string index_sha256;    ///< of that file's bytes
  int rows = 0;                ///< in the file
  int samples = 0;             ///< in the demonstration
  double duration = 0.0;       ///< s, in the file
  double smallest_step = 0.0;  ///< s, between neighbouring rows
  double largest_step = 0.0;   ///< s
  double trimmed_start = 0.0;  ///< s cut off before the movement
  double trimmed_end = 0.0;    ///< s cut off after it
};

/// Of one recording, after resampling: a day at 100 Hz. A longer one is a time column in another unit than seconds.
inline constexpr double kMaxSamples = 1e7;

struct SourceReading {
  std::vector<Demonstration> demonstrations;  ///< in the order of paths and of the index
  std::vector<FileReport> files;              ///< one per demonstration
};

/// Reads recordings. A path is a directory laid out as the description says, or one recording inside such a directory.
/// Time is linearly resampled when the description says so (no low-pass filter: a rate above the wanted one aliases),
/// trimmed, and then counted from the first sample kept. Labels: those of the description, "source", and, when the
/// description calibrates, "calibration" = "range by LABEL". Throws InputError with file, line, field, value and
/// expectation; also when a recording would have more than kMaxSamples at the wanted rate.
SourceReading read_source(const std::vector<std::filesystem::path>& paths, const SourceDescription& source);

struct ChannelSummary {
  std::string name;
  double min = 0.0;          ///< rad
  double max = 0.0;          ///< rad
  int recordings = 0;        ///< that have the channel
  int stuck_recordings = 0;  ///< in which it never changes
};

struct Summary {
  int recordings = 0;
  std::int64_t samples = 0;
  double duration = 0.0;                 ///< s, of all recordings
  double lowest_rate = 0.0;              ///< Hz, (samples - 1) / duration over the recordings
  double highest_rate = 0.0;             ///< Hz
  std::vector<ChannelSummary> channels;  ///< in order of appearance
  std::map<std::string, std::map<std::string, int>> recordings_per_label;  ///< label -> value -> count
};

/// What ingest --dry-run prints.
Summary summarize(const std::vector<Demonstration>& demonstrations);

}  // namespace opponens::storage
