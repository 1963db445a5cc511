// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <numbers>
#include <set>

#include "core/require.hpp"
#include "storage/posix_file.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/resample.hpp"
#include "storage/readers/source.hpp"
#include "storage/sha256.hpp"
#include "storage/text.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;

/// One line of an index: a recording and its labels.
struct IndexRow {
  fs::path file;
  fs::path index;
  std::string index_sha256;
  long line = 0;
  std::map<std::string, std::string> labels;
};

std::vector<IndexRow> read_index(const fs::path& root, const SourceDescription& source) {
  const fs::path path = root / source.index;
  const std::string text = read_file(path);
  if (!is_utf8(text)) throw InputError(path.string() + ": not UTF-8 text: expected a CSV index in UTF-8");
  CsvReader csv(text, path);
  const std::size_t file_column = csv.column(source.file_column, "file column");
  std::map<std::string, std::size_t> label_columns;
  for (const auto& [label, column] : source.labels) label_columns[label] = csv.column(column, "label column");
  const std::string hash = sha256(text);
  std::vector<IndexRow> rows;
  while (csv.next()) {
    if (csv.cell(file_column).empty()) csv.fail(file_column, "the name of a recording's file");
    IndexRow row{root / source.folder / fs::path(csv.cell(file_column)), path, hash, csv.line(), {}};
    std::error_code error;
    if (!fs::is_regular_file(row.file, error)) {
      csv.fail(file_column, "a file that exists (" + row.file.string() + " does not)");
    }
    for (const auto& [label, column] : label_columns) row.labels[label] = csv.cell(column);
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(path.string() + ": the index lists no recordings");
  return rows;
}

/// The directory that a recording's description is relative to: its own, less the folder.
fs::path root_of(const fs::path& recording, const SourceDescription& source) {
  fs::path root = recording.parent_path();
  for (const auto& part : fs::path(source.folder)) {
    if (!part.empty() && part != ".") root = root / "..";
  }
  return root.empty() ? "." : root;
}

std::vector<IndexRow> rows_of(const fs::path& path, const SourceDescription& source) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path.string() + ": no such file or directory");
  if (fs::is_directory(status)) return read_index(path, source);
  const fs::path root = root_of(path, source);
  std::vector<IndexRow> rows = read_index(root, source);
  std::erase_if(rows, [&](const IndexRow& row) { return !fs::equivalent(row.file, path, error); });
  if (rows.empty()) throw InputError(path.string() + ": not listed in " + (root / source.index).string());
  rows.resize(1);
  rows.front().file = path;
  return rows;
}

struct Columns {
  std::size_t time;
  std::vector<std::size_t> channels;
};

Columns find_columns(const CsvReader& csv, const fs::path& file, const SourceDescription& source) {
  Columns columns{csv.column(source.time_column, "time column"), {}};
  std::set<std::string_view> known{source.time_column};
  for (const auto& channel : source.channels) {
    columns.channels.push_back(csv.column(channel.column, "channel"));
    known.insert(channel.column);
  }
  known.insert(source.ignored_columns.begin(), source.ignored_columns.end());
  for (const auto name : csv.header()) {
    if (known.contains(name)) continue;
    throw_input(file, 1, "unknown channel: column", std::string(name),
                "a column that the source's 'time', 'channels' or 'ignore' names");
  }
  return columns;
}

Samples to_samples(const std::vector<double>& values, std::size_t width) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> table(values.data(), static_cast<Eigen::Index>(values.size() / width),
                                         static_cast<Eigen::Index>(width));
  return {table.col(0), table.rightCols(table.cols() - 1)};
}

Samples parse_samples(const std::string& text, const fs::path& file, const SourceDescription& source) {
  const double to_rad = source.unit == AngleUnit::deg ? std::numbers::pi / 180.0 : 1.0;
  CsvReader csv(text, file);
  const Columns columns = find_columns(csv, file, source);
  const std::size_t width = columns.channels.size() + 1;
  std::vector<double> values;
  long previous_line = 0;
  while (csv.next()) {
    const double time = csv.number(columns.time);
    if (previous_line > 0 && !(time > values[values.size() - width])) {
      const bool equal = time == values[values.size() - width];
      csv.fail(columns.time, "a time after that of line " + std::to_string(previous_line) + " (" +
                                 std::to_string(values[values.size() - width]) + " s): time " +
                                 (equal ? "stands still" : "goes back"));
    }
    previous_line = csv.line();
    values.push_back(time);
    for (std::size_t i = 0; i < columns.channels.size(); ++i) {
      values.push_back(source.channels[i].sign * to_rad * csv.number(columns.channels[i]));
    }
  }
  if (values.size() < 2 * width) {
    throw_input(file, 0, "number of rows", std::to_string(values.size() / width), "at least 2 samples");
  }
  return to_samples(values, width);
}

std::map<std::string, std::string> labels_of(const IndexRow& row, const SourceDescription& source) {
  std::map<std::string, std::string> labels = row.labels;
  labels["source"] = source.name;
  if (source.calibrate_by) labels["calibration"] = "range by " + *source.calibrate_by;
  return labels;
}

/// A time in milliseconds taken for seconds would ask for a thousand times the samples, or for more than memory holds.
void require_resamplable(const Samples& samples, double rate, const fs::path& file) {
  const double end = samples.time[samples.time.size() - 1];
  if ((end - samples.time[0]) * rate <= kMaxSamples) return;
  char value[40];
  std::snprintf(value, sizeof value, "%.10g s", end);
  char limit[120];
  std::snprintf(limit, sizeof limit, "at most %.3g samples at resample.rate %.4g Hz; is the time in seconds?",
                kMaxSamples, rate);
  throw_input(file, 0, "the last time", value, limit);
}

void read_recording(const IndexRow& row, const SourceDescription& source, SourceReading& reading) {
  const std::string text = read_file(row.file);
  Samples samples = parse_samples(text, row.file, source);
  const Eigen::Index rows = samples.time.size();
  const double start = samples.time[0];
  const double end = samples.time[rows - 1];
  const Eigen::VectorXd steps = samples.time.tail(rows - 1) - samples.time.head(rows - 1);
  if (source.resample_rate) {
    require_resamplable(samples, *source.resample_rate, row.file);
    samples = resample(samples, *source.resample_rate);
  }
  if (source.trim) samples = trim(samples, *source.trim);
  const Eigen::Index kept = samples.time.size();
  if (kept < 2) {
    throw_input(row.file, 0, "number of samples after resampling and trimming", std::to_string(kept),
                "at least 2: the hand moves faster than trim.speed for longer than that");
  }
  FileReport report{row.file, row.file.stem().string(), sha256(text), row.index.filename().string(), row.index_sha256};
  report.rows = static_cast<int>(rows);
  report.samples = static_cast<int>(kept);
  report.duration = end - start;
  report.smallest_step = steps.minCoeff();
  report.largest_step = steps.maxCoeff();
  report.trimmed_start = samples.time[0] - start;
  report.trimmed_end = end - samples.time[kept - 1];

  Demonstration demonstration;
  demonstration.id = report.id;
  demonstration.labels = labels_of(row, source);
  demonstration.origin = source.origin;
  demonstration.time = samples.time.array() - samples.time[0];
  for (const auto& channel : source.channels) demonstration.joint_names.push_back(channel.joint);
  demonstration.q_h = std::move(samples.q);
  reading.demonstrations.push_back(std::move(demonstration));
  reading.files.push_back(std::move(report));
}

}  // namespace

SourceReading read_source(const std::vector<fs::path>& paths, const SourceDescription& source) {
  SourceReading reading;
  std::set<std::string> ids;
  for (const auto& path : paths) {
    for (const auto& row : rows_of(path, source)) {
      const std::string id = row.file.stem().string();
      if (!ids.insert(id).second) throw_input(row.index, row.line, "recording", id, "each recording once");
      read_recording(row, source, reading);
    }
  }
  return reading;
}

}  // namespace opponens::storage
