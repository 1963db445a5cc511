// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/demonstration.hpp"

namespace opponens::storage {

/// The channels of a human hand that a source may map its columns to. rad; flexion positive; abduction positive away
/// from the middle finger (of the thumb: away from the palm; of the middle finger itself: towards the thumb).
const std::vector<std::string>& human_hand_channels();

/// Two values, and what they stand for elsewhere.
using Pair = std::array<double, 2>;

/// One column of a recording and the channel it is: rad = sign * column (after conversion to rad).
struct ChannelSource {
  std::string column;  ///< name in the header; where there is none, number from 1; of HDF5 a path, "obs/q:3"
  std::string joint;
  double sign = 1.0;
  std::optional<Pair> raw{};  ///< counts at the two points of a calibration; absent: AngleUnit::raw's range
  std::optional<Pair> rad{};  ///< rad at the same two points
};

/// Keeps the part of a recording between the first and the last time at which the hand moves: the largest
/// |q(t + window/2) - q(t - window/2)| / window over the channels is above speed.
struct TrimRule {
  double speed = 0.2;   ///< rad/s
  double window = 0.5;  ///< s; long enough that one step of a sensor is not a movement
};

enum class AngleUnit { rad, deg, raw };

/// What the recordings become: glove recordings, motions of a robot hand, or glove postures without time.
enum class RecordingKind { demonstration, hand_demonstration };

/// Where recordings are found below a PATH, and what is known of each from there.
struct RecordingFiles {
  std::string index;               ///< index file, relative to PATH; empty: files are found by their names
  std::string folder;              ///< folder of the recordings, relative to PATH; may be empty
  std::string file_column;         ///< column of the index that names a recording's file
  std::string expression;          ///< ECMAScript regular expression that the whole of a file's path below PATH matches
  std::vector<std::string> parts;  ///< names of the expression's groups, in order
};

/// One dimension of a MATLAB cell array (or one of those after the first two of a numeric array).
struct CellLabels {
  std::string name;                 ///< e.g. "subject"
  std::vector<std::string> values;  ///< one per cell along the dimension
};

enum class TableFormat { csv, text, matlab, hdf5 };

/// How the numbers lie in a file.
struct TableLayout {
  TableFormat format = TableFormat::csv;
  std::size_t columns = 0;          ///< in every line of text, or of a MATLAB matrix; 0: not fixed (MATLAB only)
  std::size_t skip_lines = 0;       ///< text: lines before the first row
  bool transposed = false;          ///< rows are channels
  std::vector<std::string> run_by;  ///< text columns: a recording is a run of rows that are equal in them
  std::string variable;             ///< MATLAB: the variable with the angles
  std::vector<CellLabels> cells;    ///< MATLAB: its cells, each of which is a recording
  std::string group;                ///< HDF5: every group in this one is a recording; empty: the file is one
};

/// Where the time of a row comes from. Exactly one of columns, variable, rate; none of them: postures without time.
struct TimeSource {
  std::vector<std::string> columns;  ///< one with the time, or six: year, month, day, hour, minute, second
  double unit = 1.0;                 ///< s per unit of the one column, or of the variable
  double rate = 0.0;                 ///< Hz, of rows that are equally spaced
  std::string variable;              ///< MATLAB: cells of the same shape
  std::string file;                  ///< MATLAB: the file with that variable, beside the recording; empty: the same
  bool present() const { return !columns.empty() || rate > 0.0 || !variable.empty(); }
};

/// Counts that stand for the two ends of ChannelSource::rad where a channel does not say: fixed, or the least and the
/// largest found in the recordings whose labels are as given (in all of them when none is given).
struct RawRange {
  std::optional<Pair> fixed;
  std::map<std::string, std::string> observed_in;
};

enum class ChannelRule { keep, drop };
enum class WeightRule { samples, recording };

/// What a source YAML says (docs/ingest.md): how recordings of one origin are laid out and what their columns mean.
struct SourceDescription {
  std::string name;
  RecordingKind kind = RecordingKind::demonstration;
  std::string hand;  ///< of a hand_demonstration: its hand.yaml
  Origin origin = Origin::recorded;
  RecordingFiles recordings;
  TableLayout table;
  std::map<std::string, std::string> labels;  ///< label -> fact: index column, part of the file name, cell label, ...
  std::map<std::string, std::string> constants;  ///< label -> text
  TimeSource time;
  AngleUnit unit = AngleUnit::rad;
  RawRange raw_range;
  bool wrap = false;  ///< angles are known up to whole turns: the first nearest to zero, no jump above half a turn
  std::vector<ChannelSource> channels;
  std::vector<std::string> ignored_columns;   ///< columns that are there and not wanted
  ChannelRule stuck = ChannelRule::keep;      ///< channels that change in no recording of the PATHs
  ChannelRule dependent = ChannelRule::keep;  ///< channels that are linear in channels before them, in all recordings
  bool split_where_time_goes_back = false;
  std::optional<double> resample_rate;  ///< Hz
  std::optional<TrimRule> trim;
  WeightRule weight = WeightRule::samples;  ///< of a recording: one per sample, or one altogether
  std::optional<std::string> calibrate_by;  ///< zero unknown: calibrate range to range per value of this label
};

/// Throws InputError naming file, line, field, value and expectation.
SourceDescription load_source(const std::filesystem::path& yaml);
SourceDescription parse_source(const std::string& text, const std::filesystem::path& yaml);

/// What was found in one file, or part of one, and what was done to it.
struct FileReport {
  std::filesystem::path file;
  std::string id;                                 ///< of its demonstration
  std::string sha256;                             ///< of the file's bytes
  std::map<std::string, std::string> companions;  ///< name -> SHA-256 of what it was read with: the index, the times
  int rows = 0;                                   ///< in the file
  int samples = 0;                                ///< in the demonstration
  double duration = 0.0;                          ///< s, in the file
  double smallest_step = 0.0;                     ///< s, between neighbouring rows
  double largest_step = 0.0;                      ///< s
  int gaps = 0;                                   ///< steps above three times the median step
  double trimmed_start = 0.0;                     ///< s cut off before the movement
  double trimmed_end = 0.0;                       ///< s cut off after it
  std::map<std::string, Pair> observed_range;     ///< channel -> counts, where they were found in recordings
  std::string calibrated_by;                      ///< SHA-256 of these recordings' files' hashes, sorted
  std::vector<std::string> dropped;               ///< channels of the description that were left out
};

/// Of one recording, after resampling: a day at 100 Hz. A longer one is a time column in another unit than seconds.
inline constexpr double kMaxSamples = 1e7;

/// The label "kind" of postures: rows without time order, whose "time" is their number.
inline constexpr const char* kPostures = "postures";

struct Recording {
  Demonstration demonstration;
  FileReport file;
};
struct ReadingInterrupted {};
using TakeRecording = std::function<void(Recording&&)>;

/// Reads recordings and hands them on one by one, in the order of paths and of the index (or of the files' names), so
/// that no more than one file is held. A path is a directory laid out as the description says, or one recording inside
/// such a directory. Labels: those of the description, "source", "kind" = "postures" of rows without time, and, when
/// the description calibrates, "calibration" = "range by LABEL". What happens to the samples: docs/ingest.md. HDF5 and
/// MATLAB files are parsed in a child process. Throws InputError with file, line, field, value and expectation; also
/// when a recording would have more than kMaxSamples at the wanted rate. interrupted is asked before each file and
/// while a child works; when it says yes, ReadingInterrupted is thrown.
void read_source(const std::vector<std::filesystem::path>& paths, const SourceDescription& source,
                 const TakeRecording& take, const std::function<bool()>& interrupted = {});

/// The same at once.
std::vector<Recording> read_source(const std::vector<std::filesystem::path>& paths, const SourceDescription& source);

struct ChannelSummary {
  std::string name;
  double min = 0.0;          ///< rad
  double max = 0.0;          ///< rad
  int recordings = 0;        ///< that have the channel
  int stuck_recordings = 0;  ///< in which it never changes
};

/// A channel that is, within every recording, a linear function of others up to kDependentShare of its variance.
struct DependentChannel {
  std::string name;
  std::vector<std::string> of;
};
inline constexpr double kDependentShare = 1e-6;

struct Summary {
  int recordings = 0;
  std::int64_t samples = 0;
  double duration = 0.0;                 ///< s, of all recordings
  double lowest_rate = 0.0;              ///< Hz, (samples - 1) / duration over the recordings
  double highest_rate = 0.0;             ///< Hz
  double largest_step = 0.0;             ///< s, between neighbouring rows of a file
  int gaps = 0;                          ///< steps of the files above three times the median step of the recording
  std::vector<ChannelSummary> channels;  ///< in order of appearance
  std::map<std::string, std::map<std::string, int>> recordings_per_label;  ///< label -> value -> count
  Eigen::MatrixXd scatter;  ///< [n x n] rad², about each recording's mean, of channels; recordings with all of them
};

/// Adds one recording to what ingest --dry-run prints.
void add(Summary& summary, const Recording& recording);

/// In order of channels: each is told by those before it.
std::vector<DependentChannel> dependent_channels(const Summary& summary);

}  // namespace opponens::storage
