// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/source.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "storage/sha256.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

const std::string kYaml = R"(name: made_up
recordings: {index: index.csv, folder: csv, file_column: file}
labels: {subject: who, object: what}
time: {column: t}
unit: deg
channels:
  - {column: index_base, joint: I_MCP, sign: -1}
  - {column: I_PIP}
ignore: [pressure]
)";
const std::string kIndex = "file,who,what\na.csv,1,cup\nb.csv,2,pen\n";
const std::string kRecording = "t,index_base,I_PIP,pressure\n1.0,-90,0,5\n1.1,-45, 10 ,5\n1.3,0,1.8e1,5\n";

/// A source on disk, with one of its files replaced.
struct Files {
  TemporaryDirectory directory;
  explicit Files(const std::string& name = "", const std::string& text = "") {
    spill(directory / "source.yaml", kYaml);
    spill(directory / "data/index.csv", kIndex);
    spill(directory / "data/csv/a.csv", kRecording);
    spill(directory / "data/csv/b.csv", kRecording);
    if (!name.empty()) spill(directory / name, text);
  }
  std::vector<Recording> read() const {
    return read_source({directory / "data"}, load_source(directory / "source.yaml"));
  }
  std::string refusal() const {
    return message_of<InputError>([&] { read(); });
  }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Source, ReadsUnitsSignsLabelsAndTime) {
  const Files files;
  const std::vector<Recording> reading = files.read();
  ASSERT_EQ(reading.size(), 2U);
  const Demonstration& first = reading[0].demonstration;
  EXPECT_EQ(first.id, "a");
  EXPECT_EQ(first.labels,
            (std::map<std::string, std::string>{{"subject", "1"}, {"object", "cup"}, {"source", "made_up"}}));
  EXPECT_EQ(first.joint_names, (std::vector<std::string>{"I_MCP", "I_PIP"}));
  const double degree = 3.14159265358979323846 / 180.0;
  Eigen::MatrixXd expected(3, 2);
  expected << 90, 0, 45, 10, 0, 18;
  EXPECT_TRUE(first.q_h.isApprox(degree * expected, 1e-15)) << first.q_h;
  EXPECT_TRUE(first.time.isApprox(Eigen::Vector3d(0.0, 0.1, 0.3), 1e-15)) << first.time;
  EXPECT_EQ(first.origin, Origin::recorded);
  const FileReport& report = reading[0].file;
  EXPECT_EQ(report.sha256, sha256(kRecording));
  EXPECT_EQ(report.companions,
            (std::map<std::string, std::string>{{"index.csv", sha256(slurp(files.directory / "data/index.csv"))}}));
  EXPECT_EQ(report.rows, 3);
  EXPECT_EQ(report.samples, 3);
  EXPECT_NEAR(report.duration, 0.3, 1e-15);
  EXPECT_NEAR(report.smallest_step, 0.1, 1e-15);
  EXPECT_NEAR(report.largest_step, 0.2, 1e-15);
}

TEST(Source, AcceptsByteOrderMarkCrLfAndBlankEnd) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : kRecording) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const Files files("data/csv/b.csv", text + "\r\n \n");
  const std::vector<Recording> reading = files.read();
  EXPECT_EQ(reading[1].demonstration.q_h, reading[0].demonstration.q_h);
}

TEST(Source, OneRecordingCanBeGiven) {
  const Files files;
  const SourceDescription source = load_source(files.directory / "source.yaml");
  const std::vector<Recording> reading = read_source({files.directory / "data/csv/b.csv"}, source);
  ASSERT_EQ(reading.size(), 1U);
  EXPECT_EQ(reading[0].demonstration.labels.at("object"), "pen");
  spill(files.directory / "data/csv/c.csv", kRecording);
  EXPECT_TRUE(contains(message_of<InputError>([&] { read_source({files.directory / "data/csv/c.csv"}, source); }),
                       {"c.csv", "not listed", "index.csv"}));
  EXPECT_TRUE(contains(message_of<InputError>([&] {
                         read_source({files.directory / "data", files.directory / "data/csv/a.csv"}, source);
                       }),
                       {"index.csv:2", "'a'", "each recording once"}));
}

TEST(Source, ResamplesLinearlyAndTrims) {
  // A ramp of 1 rad in 1 s between two holds of 1 s, sampled irregularly; 10 Hz, so every value is known.
  std::string text = "t,index_base,I_PIP,pressure\n";
  for (const double t : {0.0, 0.3, 0.95, 1.0, 1.02, 1.5, 1.9, 2.0, 2.6, 3.0}) {
    const double q = std::clamp(t - 1.0, 0.0, 1.0);
    text += std::to_string(t + 5.0) + "," + std::to_string(-q) + ",0,0\n";
  }
  Files files("data/csv/a.csv", text);
  spill(files.directory / "data/csv/b.csv", text);
  const std::string yaml = replaced(kYaml, "unit: deg", "unit: rad\nresample: {rate: 10}");
  spill(files.directory / "source.yaml", yaml);
  const Demonstration whole = files.read()[0].demonstration;
  ASSERT_EQ(whole.time.size(), 31);
  for (int i = 0; i <= 30; ++i) {
    EXPECT_NEAR(whole.time[i], 0.1 * i, 1e-12);
    EXPECT_NEAR(whole.q_h(i, 0), std::clamp(0.1 * i - 1.0, 0.0, 1.0), 1e-9);
  }
  // Change over 0.2 s is 0.2 rad inside the ramp, 0.1 rad at its ends (i = 10, 20) and 0 outside.
  spill(files.directory / "source.yaml", yaml + "trim: {speed: 0.25, window: 0.2}\n");
  std::vector<Recording> trimmed = files.read();
  EXPECT_EQ(trimmed[0].demonstration.time.size(), 11);
  EXPECT_EQ(trimmed[0].demonstration.time[0], 0.0);
  EXPECT_NEAR(trimmed[0].demonstration.q_h(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(trimmed[0].demonstration.q_h(10, 0), 1.0, 1e-9);
  EXPECT_NEAR(trimmed[0].file.trimmed_start, 1.0, 1e-9);
  EXPECT_NEAR(trimmed[0].file.trimmed_end, 1.0, 1e-9);
  spill(files.directory / "source.yaml", yaml + "trim: {speed: 0.75, window: 0.2}\n");
  EXPECT_EQ(files.read()[0].demonstration.time.size(), 9);
  spill(files.directory / "source.yaml", yaml + "trim: {speed: 2, window: 0.2}\n");
  EXPECT_TRUE(contains(files.refusal(), {"a.csv", "after resampling and trimming", "'0'", "trim.speed"}));
}

TEST(Source, AConstantChannelStaysConstantWhenResampled) {
  std::string text = "t,index_base,I_PIP,pressure\n";
  for (int i = 0; i <= 40; ++i) text += std::to_string(0.032 * i) + "," + std::to_string(i) + ",0.1,0\n";
  const Files files("data/csv/a.csv", text);
  spill(files.directory / "source.yaml", replaced(kYaml, "unit: deg", "unit: rad\nresample: {rate: 70}"));
  const Recording recording = files.read()[0];
  EXPECT_EQ(recording.demonstration.q_h.col(1).minCoeff(), 0.1);
  EXPECT_EQ(recording.demonstration.q_h.col(1).maxCoeff(), 0.1);
  Summary summary;
  add(summary, recording);
  EXPECT_EQ(summary.channels[0].stuck_recordings, 0);
  EXPECT_EQ(summary.channels[1].stuck_recordings, 1);
}

TEST(Source, TooManySamplesAreRefusedBeforeTheyAreMade) {
  const std::string yaml = replaced(kYaml, "unit: deg", "unit: rad\nresample: {rate: 10}");
  const auto refusal = [&](const std::string& last) {
    const Files files("data/csv/a.csv", "t,index_base,I_PIP,pressure\n5,0,0,0\n" + last + ",1,1,0\n");
    spill(files.directory / "source.yaml", yaml);
    return files.refusal();
  };
  // (10^9 - 5) s at 10 Hz; the limit is 10^7 samples, so 10^6 s are just allowed.
  EXPECT_TRUE(
      contains(refusal("1e9"), {"a.csv", "'999999995 s'", "1e+07 samples", "10 Hz", "is the time in seconds?"}));
  EXPECT_TRUE(contains(refusal("1e300"), {"a.csv", "'1e+300 s'"}));
  EXPECT_TRUE(contains(refusal("1000005.2"), {"a.csv", "'1000000.2 s'"}));
}

TEST(Source, CalibrationBecomesALabel) {
  const Files files("source.yaml", kYaml + "calibrate: {method: range, by: subject}\n");
  const Demonstration first = files.read()[0].demonstration;
  EXPECT_EQ(first.labels.at("calibration"), "range by subject");
}

struct BadFile {
  std::string name;
  std::string text;
  std::vector<std::string> message;
};

TEST(Source, BadRecordingsNameFileLineFieldValueAndExpectation) {
  const std::string name = "data/csv/b.csv";
  const std::string& good = kRecording;
  const std::vector<BadFile> cases{
      {name, "", {"b.csv: the file is empty", "header"}},
      {name, "\n \n", {"b.csv: the file is empty"}},
      {name, "t,index_base,I_PIP,pressure\n", {"b.csv: number of rows is '0'", "at least 2"}},
      {name, replaced(good, "-45", "nan"), {"b.csv:3: field 'index_base' is 'nan': expected a finite number"}},
      {name, replaced(good, "-45", "inf"), {"b.csv:3: field 'index_base' is 'inf'"}},
      {name, replaced(good, "-45", "4x"), {"b.csv:3: field 'index_base' is '4x': expected a finite number"}},
      {name, replaced(good, "-45", ""), {"b.csv:3: field 'index_base' is ''"}},
      {name, replaced(good, "-45", "1e999"), {"b.csv:3: field 'index_base' is '1e999'"}},
      {name, replaced(good, "0,1.8e1,5", "0,1.8e1"), {"b.csv:4: number of columns is '3': expected 4"}},
      {name, replaced(good, "0,1.8e1,5", "0,1.8e1,5,6"), {"b.csv:4: number of columns is '5': expected 4"}},
      {name, replaced(good, "1.3,", "1.1,"), {"b.csv:4: field 't' is '1.1'", "line 3", "stands still"}},
      {name, replaced(good, "1.3,", "0.9,"), {"b.csv:4: field 't' is '0.9'", "line 3", "goes back"}},
      {name,
       replaced(replaced(good, "1.1,", "1e308,"), "1.0,", "-1e308,"),
       {"b.csv:3: field 't' is '1e+308'", "leaps"}},
      {name, "t,index_base,I_PIP,pressure\n-1,0,0,0\n1e-20,0,0,0\n2e-20,1,0,0\n", {"b.csv:4", "stands still"}},
      {name, replaced(good, "1.1,", "\n1.1,"), {"b.csv:3: number of columns is '1': expected 4"}},
      {name, replaced(good, "I_PIP", "I_DIP"), {"b.csv:1: header is", "I_DIP", "expected a channel 'I_PIP'"}},
      {name, replaced(good, "pressure", "mystery"), {"b.csv:1: unknown channel: column is 'mystery'", "'ignore'"}},
      {name, replaced(good, "pressure", "t"), {"b.csv:1: column name is 't': expected each name once"}},
      {name, replaced(good, "pressure", ""), {"b.csv:1: a column's name is ''"}},
      {"data/index.csv", "", {"index.csv: the file is empty"}},
      {"data/index.csv", "file,who,what\n", {"index.csv: the index lists no recordings"}},
      {"data/index.csv", replaced(kIndex, "who", "whom"), {"index.csv:1: header is 'file, what, whom'", "'who'"}},
      {"data/index.csv", replaced(kIndex, "file", "name"), {"index.csv:1:", "file column 'file'"}},
      {"data/index.csv", replaced(kIndex, "b.csv", "z.csv"), {"index.csv:3: field 'file' is 'z.csv'", "exists"}},
      {"data/index.csv", replaced(kIndex, "b.csv", ""), {"index.csv:3: field 'file' is ''"}},
      {"data/index.csv", replaced(kIndex, "b.csv", "a.csv"), {"index.csv:3: recording is 'a'", "once"}},
      {"data/index.csv", replaced(kIndex, "pen", "p\xFF"), {"index.csv", "UTF-8"}},
  };
  for (const auto& bad : cases) {
    const Files files(bad.name, bad.text);
    EXPECT_TRUE(contains(files.refusal(), bad.message)) << bad.text;
  }
}

TEST(Source, BadDescriptionsNameFileLineFieldValueAndExpectation) {
  const auto with = [](const std::string& from, const std::string& to) { return replaced(kYaml, from, to); };
  const std::string name = "source.yaml";
  const std::vector<BadFile> cases{
      {name, "a: [", {"source.yaml:", "not YAML"}},
      {name, "", {"the document", "a mapping"}},
      {name, with("unit: deg", "unit: degrees"), {"source.yaml:5: unit is 'degrees': expected one of rad, deg, raw"}},
      {name, with("unit: deg", "units: deg"), {"source.yaml:5: key is 'units': expected one of name, origin"}},
      {name, with("unit: deg", "unit: deg\nunit: deg"), {"source.yaml:6: key is 'unit'", "once"}},
      {name, with("joint: I_MCP", "joint: I_CMC"), {"source.yaml:7: unknown channel: joint is 'I_CMC'", "T_ROT"}},
      {name, with("sign: -1", "sign: -2"), {"source.yaml:7:", "'-2': expected 1 or -1"}},
      {name, with("{column: I_PIP}", "{column: I_MCP}"), {"source.yaml:8: joint is 'I_MCP'", "once"}},
      {name, with("{column: I_PIP}", "I_PIP"), {"source.yaml:8: channels[1] is 'I_PIP'", "mapping"}},
      {name, with("file_column: file", "folder: x"), {"source.yaml:2: key is 'folder'", "once"}},
      {name, with(", file_column: file", ""), {"source.yaml:2: recordings.file_column", "missing"}},
      {name, with("subject: who", "source: who"), {"labels", "'source'"}},
      {name, kYaml + "resample: {rate: 0}\n", {"source.yaml:10: resample.rate is '0': expected a number above 0"}},
      {name, kYaml + "resample: {rate: fast}\n", {"'fast'"}},
      {name, kYaml + "trim: {speed: 0.1}\n", {"trim.window", "missing"}},
      {name, kYaml + "calibrate: {method: guess, by: subject}\n", {"'guess': expected range"}},
      {name, kYaml + "calibrate: {method: range, by: day}\n", {"calibrate.by is 'day'", "label"}},
      {name, kYaml + "hand_length: 0.19\n", {"key is 'hand_length'", "one of"}},
  };
  for (const auto& bad : cases) {
    const Files files(bad.name, bad.text);
    EXPECT_TRUE(contains(files.refusal(), bad.message)) << bad.text;
  }
}

TEST(Source, AbsentFilesAreNamed) {
  const Files files;
  const SourceDescription source = load_source(files.directory / "source.yaml");
  EXPECT_TRUE(contains(message_of<InputError>([&] { read_source({files.directory / "nowhere"}, source); }),
                       {"nowhere", "no such file"}));
  EXPECT_TRUE(
      contains(message_of<InputError>([&] { load_source(files.directory / "no.yaml"); }), {"no.yaml", "No such file"}));
  fs::remove(files.directory / "data/index.csv");
  EXPECT_TRUE(contains(files.refusal(), {"index.csv", "No such file"}));
}

TEST(Summarize, RangesRatesStuckChannelsAndLabels) {
  const Files files("data/csv/b.csv", "t,index_base,I_PIP,pressure\n0,-180,7,0\n1,0,7,0\n");
  Summary summary;
  for (const auto& recording : files.read()) add(summary, recording);
  EXPECT_EQ(summary.recordings, 2);
  EXPECT_EQ(summary.samples, 5);
  EXPECT_NEAR(summary.duration, 1.3, 1e-12);
  EXPECT_NEAR(summary.lowest_rate, 1.0, 1e-12);
  EXPECT_NEAR(summary.highest_rate, 2.0 / 0.3, 1e-12);
  ASSERT_EQ(summary.channels.size(), 2U);
  EXPECT_EQ(summary.channels[0].stuck_recordings, 0);
  EXPECT_NEAR(summary.channels[0].max, 3.14159265358979, 1e-12);
  EXPECT_NEAR(summary.channels[0].min, 0.0, 1e-12);
  EXPECT_EQ(summary.channels[1].stuck_recordings, 1);
  EXPECT_EQ(summary.channels[1].recordings, 2);
  EXPECT_EQ(summary.recordings_per_label.at("object").at("cup"), 1);
  EXPECT_EQ(summary.recordings_per_label.at("source").at("made_up"), 2);
}

}  // namespace
}  // namespace opponens::storage::test
