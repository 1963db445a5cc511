// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/interpret.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "core/require.hpp"
#include "storage/readers/csv.hpp"
#include "storage/readers/resample.hpp"

namespace opponens::storage {
namespace {

namespace fs = std::filesystem;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// The name of the fact that numbers the trials of a table.
constexpr const char* kTrial = "trial";

std::string shortest(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

long line_of(const Table& table, Eigen::Index row) { return table.first_line == 0 ? 0 : table.first_line + row; }

/// For messages: where rows have no lines they have numbers.
std::string row_name(const Table& table, Eigen::Index row) {
  return (table.first_line == 0 ? "row " : "line ") +
         std::to_string(table.first_line == 0 ? row + 1 : line_of(table, row));
}

[[noreturn]] void fail_row(const Table& table, const fs::path& file, Eigen::Index row, const std::string& column,
                           double value, const std::string& expectation) {
  std::string field = "field '" + column + "'";
  if (table.first_line == 0) {
    field += (table.part.empty() ? std::string() : " of " + table.part) + " in row " + std::to_string(row + 1);
  }
  throw_input(file, line_of(table, row), field, shortest(value), expectation);
}

std::string time_name(const SourceDescription& source) {
  if (!source.time.variable.empty()) return source.time.variable;
  return source.time.columns.size() == 1 ? source.time.columns.front() : "date";
}

/// The rows of one trial: [begin, end).
struct Range {
  Eigen::Index begin;
  Eigen::Index end;
};

/// Cuts where time goes back when that is asked for; else time has to increase.
std::vector<Range> trials_of(const Eigen::VectorXd& time, const Table& table, const fs::path& file,
                             const SourceDescription& source) {
  std::vector<Range> trials{{0, time.size()}};
  for (Eigen::Index i = 1; i < time.size(); ++i) {
    // As it is stored, from the trial's first sample on: two large times may then be one, or infinitely far apart.
    const double start = time[trials.back().begin];
    const double step = (time[i] - start) - (time[i - 1] - start);
    if (step > 0.0 && std::isfinite(step)) continue;
    const bool back = time[i] < time[i - 1];
    if (!back || !source.split_where_time_goes_back) {
      const char* what = back ? "goes back" : step > 0.0 ? "leaps by more than a number can tell" : "stands still";
      fail_row(table, file, i, time_name(source), time[i],
               "a time after that of " + row_name(table, i - 1) + " (" + shortest(time[i - 1]) + " s): time " + what);
    }
    trials.back().end = i;
    trials.push_back({i, time.size()});
  }
  return trials;
}

/// rad = offset + factor * value.
struct Line {
  double factor;
  double offset;
};

Line calibration_of(const ChannelSource& channel, AngleUnit unit, const Pair& observed) {
  if (unit == AngleUnit::rad) return {channel.sign, 0.0};
  if (unit == AngleUnit::deg) return {channel.sign * (std::numbers::pi / 180.0), 0.0};
  const Pair raw = channel.raw.value_or(observed);
  const Pair rad = *channel.rad;
  // A sensor that never moved has no range; it is stuck, and at the first of its angles.
  const double factor = raw[0] == raw[1] ? 0.0 : (rad[1] - rad[0]) / (raw[1] - raw[0]);
  return {channel.sign * factor, channel.sign * (rad[0] - factor * raw[0])};
}

Eigen::MatrixXd angles_of(const Table& table, const fs::path& file, const SourceDescription& source,
                          const Survey& survey) {
  const auto rows = static_cast<Eigen::Index>(table.rows());
  const std::size_t first = time_width(source);
  std::vector<Line> lines;
  for (const auto channel : survey.kept) {
    lines.push_back(calibration_of(source.channels[channel], source.unit, survey.raw[channel]));
  }
  Eigen::MatrixXd angles(rows, static_cast<Eigen::Index>(survey.kept.size()));
  for (Eigen::Index i = 0; i < rows; ++i) {  // row by row, as the values lie in memory
    const double* row = table.values.data() + static_cast<std::size_t>(i) * table.width + first;
    for (std::size_t j = 0; j < lines.size(); ++j) {
      const double value = row[survey.kept[j]];
      const Line& line = lines[j];
      const double angle = line.offset == 0.0 ? line.factor * value : line.offset + line.factor * value;
      if (!std::isfinite(angle)) {
        fail_row(table, file, i, source.channels[survey.kept[j]].column, value, "a finite number");
      }
      angles(i, static_cast<Eigen::Index>(j)) = angle;
    }
  }
  return angles;
}

/// Angles that are known up to whole turns: the first of each trial nearest to zero, then no jump above half a turn.
/// Postures have no neighbours: each is taken nearest to zero.
void unwrap(Samples& samples, bool ordered) {
  for (Eigen::Index j = 0; j < samples.q.cols(); ++j) {
    for (Eigen::Index i = 0; i < samples.q.rows(); ++i) {
      const double near = i > 0 && ordered ? samples.q(i - 1, j) : 0.0;
      samples.q(i, j) -= kTurn * std::round((samples.q(i, j) - near) / kTurn);
    }
  }
}

/// A time in milliseconds taken for seconds would ask for a thousand times the samples, or for more than memory holds.
void require_resamplable(const Samples& samples, double rate, const fs::path& file) {
  const double duration = samples.time[samples.time.size() - 1];
  if (duration * rate <= kMaxSamples) return;
  char limit[120];
  std::snprintf(limit, sizeof limit, "at most %.3g samples at resample.rate %.4g Hz; is the time in seconds?",
                kMaxSamples, rate);
  throw_input(file, 0, "the duration", shortest(duration) + " s", limit);
}

void report_steps(const Eigen::VectorXd& time, FileReport& report) {
  const Eigen::Index count = time.size() - 1;
  Eigen::VectorXd steps = time.tail(count) - time.head(count);
  report.smallest_step = steps.minCoeff();
  report.largest_step = steps.maxCoeff();
  auto* const middle = steps.data() + count / 2;
  std::nth_element(steps.data(), middle, steps.data() + count);
  const double median = *middle;
  report.gaps = static_cast<int>(
      std::count_if(steps.data(), steps.data() + count, [&](double step) { return step > 3.0 * median; }));
}

/// Resampling, trimming, and what the report says of them.
Samples process(Samples samples, const SourceDescription& source, FileReport& report) {
  const double start = samples.time[0];
  const double end = samples.time[samples.time.size() - 1];
  report.duration = end - start;
  report_steps(samples.time, report);
  if (source.wrap) unwrap(samples, source.time.present());
  if (source.resample_rate) {
    require_resamplable(samples, *source.resample_rate, report.file);
    samples = resample(samples, *source.resample_rate);
  }
  if (source.trim) samples = trim(samples, *source.trim);
  const Eigen::Index kept = samples.time.size();
  if (kept < 2) {
    throw_input(report.file, 0, "number of samples after resampling and trimming", std::to_string(kept),
                "at least 2: the hand moves faster than trim.speed for longer than that");
  }
  report.samples = static_cast<int>(kept);
  report.trimmed_start = samples.time[0] - start;
  report.trimmed_end = end - samples.time[kept - 1];
  return samples;
}

/// Days since 1970-01-01 of a date of the Gregorian calendar (H. Hinnant, days_from_civil).
double days_of(double year, double month, double day) {
  const double y = month <= 2.0 ? year - 1.0 : year;
  const double era = std::floor(y / 400.0);
  const double year_of_era = y - 400.0 * era;
  const double day_of_year = std::floor((153.0 * (month + (month > 2.0 ? -3.0 : 9.0)) + 2.0) / 5.0) + day - 1.0;
  const double day_of_era =
      365.0 * year_of_era + std::floor(year_of_era / 4.0) - std::floor(year_of_era / 100.0) + day_of_year;
  return 146097.0 * era + day_of_era - 719468.0;
}

/// Days before a date, and the seconds of the day, apart: their sum would cost digits.
std::pair<double, double> date_of(const Table& table, Eigen::Index row, const fs::path& file,
                                  const SourceDescription& source) {
  const double* fields = table.values.data() + static_cast<std::size_t>(row) * table.width;
  constexpr std::array<Pair, 6> kLimits{{{1, 9999}, {1, 12}, {1, 31}, {0, 23}, {0, 59}, {0, 61}}};
  for (std::size_t i = 0; i < 6; ++i) {
    const bool whole = i == 5 || fields[i] == std::floor(fields[i]);
    if (whole && fields[i] >= kLimits[i][0] && fields[i] <= kLimits[i][1]) continue;
    fail_row(table, file, row, source.time.columns[i], fields[i],
             "year, month, day, hour, minute, second of a date; this field from " + shortest(kLimits[i][0]) + " to " +
                 shortest(kLimits[i][1]));
  }
  return {days_of(fields[0], fields[1], fields[2]), 3600.0 * fields[3] + 60.0 * fields[4] + fields[5]};
}

}  // namespace

Eigen::VectorXd times_of(const Table& table, const RecordingFile& file, const SourceDescription& source) {
  const auto rows = static_cast<Eigen::Index>(table.rows());
  if (time_width(source) == 0) {
    const double step = source.time.rate > 0.0 ? 1.0 / source.time.rate : 1.0;
    return step * Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
  }
  Eigen::VectorXd time(rows);
  double first_day = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (source.time.columns.size() == 6) {
      const auto [day, second] = date_of(table, i, file.file, source);
      if (i == 0) first_day = day;
      time[i] = 86400.0 * (day - first_day) + second;
      continue;
    }
    const double value = table.values[static_cast<std::size_t>(i) * table.width];
    time[i] = source.time.unit * value;
    if (!std::isfinite(time[i])) fail_row(table, file.file, i, time_name(source), value, "a finite number");
  }
  return time;
}

std::map<std::string, std::string> labels_of(const Table& table, const RecordingFile& file,
                                             const SourceDescription& source) {
  std::map<std::string, std::string> labels = source.constants;
  for (const auto& [label, fact] : source.labels) {
    if (const auto of_table = table.facts.find(fact); of_table != table.facts.end()) {
      labels[label] = of_table->second;
    } else if (const auto of_file = file.facts.find(fact); of_file != file.facts.end()) {
      labels[label] = of_file->second;
    } else if (fact != kTrial || !source.split_where_time_goes_back) {
      std::string known;
      for (const auto* facts : {&file.facts, &table.facts}) {
        for (const auto& [name, value] : *facts) known += (known.empty() ? "" : ", ") + name;
      }
      const bool index = !file.index.empty();
      throw_input(index ? file.index : file.file, index ? 1 : 0, index ? "header" : "what is known of the file", known,
                  "a label column '" + fact + "'");
    }
  }
  labels["source"] = source.name;
  if (!source.time.present()) labels["kind"] = kPostures;
  if (source.calibrate_by) labels["calibration"] = "range by " + *source.calibrate_by;
  return labels;
}

void interpret(const Table& table, const RecordingFile& file, const std::string& sha256,
               const SourceDescription& source, const Survey& survey, const TakeRecording& take) {
  const auto labels = labels_of(table, file, source);
  const Eigen::VectorXd time = times_of(table, file, source);
  const std::vector<Range> trials = trials_of(time, table, file.file, source);
  Eigen::MatrixXd angles = angles_of(table, file.file, source, survey);
  const std::string id = table.part.empty() ? file.id : file.id + "_" + table.part;
  for (std::size_t trial = 0; trial < trials.size(); ++trial) {
    const auto [begin, end] = trials[trial];
    const Eigen::Index rows = end - begin;
    if (rows < 2) {
      throw_input(file.file, 0, "number of rows" + (table.part.empty() ? "" : " of " + table.part),
                  std::to_string(rows), "at least 2 samples");
    }
    Recording recording;
    FileReport& report = recording.file;
    const std::string number = std::to_string(trial + 1);
    report.file = file.file;
    report.id = source.split_where_time_goes_back ? id + "_" + number : id;
    report.sha256 = sha256;
    report.companions = file.companions;
    report.rows = static_cast<int>(rows);
    Samples samples{time.segment(begin, rows).array() - time[begin], {}};
    samples.q = trials.size() == 1 ? std::move(angles) : Eigen::MatrixXd(angles.middleRows(begin, rows));
    samples = process(std::move(samples), source, report);
    Demonstration& demonstration = recording.demonstration;
    demonstration.id = report.id;
    demonstration.labels = labels;
    for (const auto& [label, fact] : source.labels) {
      if (fact == kTrial && source.split_where_time_goes_back) demonstration.labels[label] = number;
    }
    demonstration.origin = source.origin;
    if (source.weight == WeightRule::recording) demonstration.weight = 1.0 / static_cast<double>(report.samples);
    demonstration.time = samples.time.array() - samples.time[0];
    for (const auto channel : survey.kept) demonstration.joint_names.push_back(source.channels[channel].joint);
    demonstration.q_h = std::move(samples.q);
    take(std::move(recording));
  }
}

}  // namespace opponens::storage
