// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Text in other forms than CSV with an index. MATLAB and HDF5: foreign_test.py.
#include <numbers>

#include "core/require.hpp"
#include "storage/readers/source.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Reads one text file "cup_s1.txt" through a description.
struct TextSource {
  TemporaryDirectory directory;
  std::string yaml;

  explicit TextSource(const std::string& rest, const std::string& text) {
    yaml = "name: made_up\nrecordings: {files: '([a-z]+)_s([0-9])\\.txt', parts: [object, subject]}\n" + rest;
    spill(directory / "data/cup_s1.txt", text);
  }
  std::vector<Recording> read() const { return read_source({directory / "data"}, parse_source(yaml, "made_up.yaml")); }
  std::string refusal() const {
    return message_of<InputError>([&] { read(); });
  }
};

const std::string kTwo = "channels: [{column: '2', joint: I_MCP}, {column: '3', joint: I_PIP}]\n";
const std::string kLabels = "labels: {object: object, subject: subject, hand: {constant: right}}\n";

Eigen::MatrixXd matrix(int columns, const std::vector<double>& values) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
}

TEST(TextFormat, TicksBracketsAndLabelsFromNameAndConstant) {
  const TextSource source(
      "table: {format: text, columns: 3, skip_lines: 1}\ntime: {column: '1', unit: 0.001}\n" + kTwo + kLabels,
      "made by hand\n1000, [0.25 -1]\n1010,[0.5,2e0]\r\n1030\t(0.75; 3)\n\n");
  const auto found = source.read();
  ASSERT_EQ(found.size(), 1U);
  const Demonstration& motion = found[0].demonstration;
  EXPECT_EQ(motion.id, "cup_s1");
  EXPECT_EQ(motion.labels, (std::map<std::string, std::string>{
                               {"object", "cup"}, {"subject", "1"}, {"hand", "right"}, {"source", "made_up"}}));
  EXPECT_EQ(motion.q_h, matrix(2, {0.25, -1, 0.5, 2, 0.75, 3}));
  EXPECT_TRUE(motion.time.isApprox(Eigen::Vector3d(0.0, 0.01, 0.03), 1e-12)) << motion.time;
  EXPECT_EQ(motion.weight, 1.0);
}

TEST(TextFormat, ARecordingHasOneNameWhateverPathLedToIt) {
  const TemporaryDirectory directory;
  const auto source = parse_source(
      "name: n\nrecordings: {files: '(?:.*/)?([a-z]+)/([^/]+)\\.txt', parts: [object, take]}\n"
      "table: {format: text, columns: 3}\ntime: {column: '1'}\nlabels: {object: object}\n" +
          kTwo,
      "n.yaml");
  spill(directory / "data/cup/one.txt", "0 1 2\n1 2 4\n");
  for (const char* path : {"", "data", "data/cup", "data/cup/one.txt", "data/../data/cup/./one.txt"}) {
    const auto found = read_source({directory / path}, source);
    ASSERT_EQ(found.size(), 1U) << path;
    EXPECT_EQ(found[0].demonstration.id, "cup_one") << path;
    EXPECT_EQ(found[0].demonstration.labels.at("object"), "cup") << path;
  }
}

TEST(TextFormat, DatesRunOverMidnightAndTheEndOfTheYear) {
  const std::string dates =
      "table: {format: text, columns: 7}\ntime: {date: ['1', '2', '3', '4', '5', '6']}\n"
      "channels: [{column: '7', joint: I_MCP}]\n";
  const auto duration = [&](const std::string& first, const std::string& last) {
    const TextSource source(dates, first + " 1\n" + last + " 2\n");
    return source.read().at(0).demonstration.time[1];
  };
  EXPECT_NEAR(duration("2014 11 28 08 42 28.03900", "2014 11 28 08 42 28.05400"), 0.015, 1e-11);
  EXPECT_NEAR(duration("2014 12 31 23 59 59.75", "2015 1 1 0 0 0.25"), 0.5, 1e-9);
  EXPECT_NEAR(duration("2016 2 28 23 59 59", "2016 3 1 0 0 1"), 86402.0, 1e-9) << "2016 has a 29 February";
  EXPECT_NEAR(duration("2100 2 28 23 59 59", "2100 3 1 0 0 1"), 2.0, 1e-9) << "2100 has none";
  for (const std::string bad : {"2014 13 1 0 0 0", "2014 1 32 0 0 0", "2014 1 1 24 0 0", "2014 1 1 0 60 0",
                                "2014 1 1.5 0 0 0", "2014 1 1 0 0 -1"}) {
    EXPECT_TRUE(contains(TextSource(dates, "2013 1 1 0 0 0 1\n" + bad + " 2\n").refusal(), {"cup_s1.txt:2: field '"}))
        << bad;
  }
}

TEST(TextFormat, RateAndTransposed) {
  const std::string text = "1 2 3\n10 20 30\n-1 -2 -3\n";
  const std::string layout = "table: {format: text, columns: 3, transposed: true}\n" + kTwo;
  const auto found = TextSource(layout + "time: {rate: 50}\n", text).read();
  EXPECT_EQ(found.at(0).demonstration.q_h, matrix(2, {10, -1, 20, -2, 30, -3}));
  EXPECT_NEAR(found.at(0).demonstration.time[2], 0.04, 1e-15);
  const auto timed = TextSource(layout + "time: {column: '1'}\n", text).read();
  EXPECT_EQ(timed.at(0).demonstration.time, Eigen::Vector3d(0, 1, 2));
  EXPECT_TRUE(contains(TextSource(layout + "time: {rate: 50}\n", "1 2 3\n10 x 30\n-1 -2 -3\n").refusal(),
                       {"cup_s1.txt: field '2' in column 2 is 'x'"}));
  EXPECT_TRUE(contains(TextSource(layout + "time: {rate: 50}\n", "1 2 3\n10 20\n").refusal(),
                       {"cup_s1.txt:2: number of columns is '2': expected 3"}));
  const TextSource named(
      "table: {format: csv, transposed: true}\ntime: {column: t}\n"
      "channels: [{column: I_MCP}]\nignore: [x]\n",
      "t, 0, 0.5\nx,7,7\nI_MCP,1,2\n");
  EXPECT_EQ(named.read().at(0).demonstration.q_h, matrix(1, {1, 2}));
}

TEST(TextFormat, RawCountsByTwoPointsByRangeAndAsObserved) {
  const std::string table = "table: {format: text, columns: 3}\ntime: {column: '1'}\nunit: raw\n";
  const std::string channels =
      "channels: [{column: '2', joint: I_MCP, rad: [0, 1], raw: [200, 700]}, "
      "{column: '3', joint: I_PIP, rad: [-1, 1], sign: -1}]\n";
  const std::string text = "0 200 0\n1 450 250\n2 700 500\n";
  const auto fixed = TextSource(table + "raw_range: [0, 1000]\n" + channels, text).read();
  EXPECT_TRUE(fixed.at(0).demonstration.q_h.isApprox(matrix(2, {0, 1, 0.5, 0.5, 1, 0}), 1e-14));
  const auto observed = TextSource(table + "raw_range: observed\n" + channels, text).read();
  EXPECT_TRUE(observed.at(0).demonstration.q_h.isApprox(matrix(2, {0, 1, 0.5, 0, 1, -1}), 1e-14));
  // Of the recordings of an open and closed hand only: 0 to 1000, so that 500 of the other is the middle.
  TextSource calibrated(table + "raw_range: {observed_in: {object: range}}\n" + channels + kLabels, text);
  spill(calibrated.directory / "data/range_s1.txt", "0 0 0\n1 9 1000\n");
  const auto found = calibrated.read();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].demonstration.q_h.isApprox(matrix(2, {0, 1, 0.5, 0.5, 1, 0}), 1e-14));
  const TextSource none(table + "raw_range: {observed_in: {object: nothing}}\n" + channels + kLabels, text);
  EXPECT_TRUE(contains(none.refusal(), {"made_up", "observed_in"}));
}

TEST(TextFormat, StuckAndDependentChannelsAreDroppedWhenAsked) {
  const std::string layout =
      "table: {format: text, columns: 5}\ntime: {column: '1'}\nchannels: [{column: '2', joint: I_MCP}, "
      "{column: '3', joint: I_PIP}, {column: '4', joint: M_MCP}, {column: '5', joint: R_MCP}]\n";
  // M_MCP = 2 I_MCP + 1; I_PIP moves in the second file only; R_MCP nowhere.
  const auto names = [&](const std::string& rules) {
    TextSource source(layout + rules, "0 1 4 3 9\n1 2 4 5 9\n2 5 4 11 9\n3 2 4 5 9\n");
    spill(source.directory / "data/pen_s1.txt", "0 1 4 3 9\n1 2 5 5 9\n2 3 4 7 9\n3 3 9 7 9\n");
    return source.read().at(0).demonstration.joint_names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(""), (Names{"I_MCP", "I_PIP", "M_MCP", "R_MCP"}));
  EXPECT_EQ(names("stuck: drop\n"), (Names{"I_MCP", "I_PIP", "M_MCP"}));
  EXPECT_EQ(names("dependent: drop\n"), (Names{"I_MCP", "I_PIP", "R_MCP"}));
  EXPECT_EQ(names("stuck: drop\ndependent: drop\n"), (Names{"I_MCP", "I_PIP"}));
}

TEST(TextFormat, WrappedAnglesStartNearZeroAndDoNotJump) {
  const std::string layout =
      "table: {format: text, columns: 2}\nunit: deg\nwrap: true\n"
      "channels: [{column: '2', joint: W_YAW}]\n";
  const std::string text = "0 350\n1 359.5\n2 3\n3 170\n4 190\n5 1\n";
  const auto found = TextSource(layout + "time: {column: '1'}\n", text).read();
  EXPECT_TRUE(found.at(0).demonstration.q_h.isApprox(kDegree * matrix(1, {-10, -0.5, 3, 170, 190, 361}), 1e-13))
      << found.at(0).demonstration.q_h / kDegree;
  const auto postures = TextSource(layout + "time: none\n", text).read();
  EXPECT_TRUE(postures.at(0).demonstration.q_h.isApprox(kDegree * matrix(1, {-10, -0.5, 3, 170, -170, 1}), 1e-13));
}

TEST(TextFormat, JoinedTrialsAreSplitAndWeighAlike) {
  const std::string layout = "table: {format: text, columns: 3}\ntime: {column: '1'}\nweight: recording\n" + kTwo;
  const std::string text = "4 0 1\n5 1 2\n6 2 3\n4.5 7 8\n4.6 8 9\n";
  const auto found = TextSource(layout + "split: where_time_goes_back\nlabels: {repetition: trial}\n", text).read();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].demonstration.id, "cup_s1_1");
  EXPECT_EQ(found[1].demonstration.labels.at("repetition"), "2");
  EXPECT_EQ(found[1].demonstration.q_h, matrix(2, {7, 8, 8, 9}));
  EXPECT_NEAR(found[1].demonstration.time[1], 0.1, 1e-12);
  for (const auto& [motion, report] : found) {
    EXPECT_NEAR(motion.weight * static_cast<double>(motion.time.size()), 1.0, 1e-15);
  }
  EXPECT_TRUE(contains(TextSource(layout, text).refusal(), {"cup_s1.txt:4: field '1' is '4.5'", "goes back"}));
  const std::string split = layout + "split: where_time_goes_back\n";
  EXPECT_TRUE(contains(TextSource(split, "4 0 1\n5 1 2\n5 2 3\n").refusal(), {"cup_s1.txt:3", "stands still"}));
  EXPECT_TRUE(contains(TextSource(split, "4 0 1\n5 1 2\n1 2 3\n").refusal(), {"number of rows is '1'"}));
}

TEST(TextFormat, PosturesAreCutIntoRunsOfEqualText) {
  const TextSource source(
      "table: {run_by: [what, how]}\ntime: none\nunit: deg\nchannels: [{column: I_MCP}]\n"
      "labels: {object: what, repetition: run}\n",
      "I_MCP,what,how\n90,cone,N\n45,cone,N\n0,pen,N\n9,pen,N\n1,cone,N\n2,cone,N\n");
  const auto found = source.read();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[2].demonstration.id, "cup_s1_cone_N_2");
  EXPECT_EQ(found[2].demonstration.labels,
            (std::map<std::string, std::string>{
                {"object", "cone"}, {"repetition", "2"}, {"kind", "postures"}, {"source", "made_up"}}));
  EXPECT_EQ(found[0].demonstration.q_h, kDegree * matrix(1, {90, 45}));
  EXPECT_EQ(found[0].demonstration.time, Eigen::Vector2d(0, 1));
}

TEST(TextFormat, RobotHandsHaveTheirOwnJointsAndGlovesHaveMaps) {
  const std::string text = "0 1 2\n1 3 4\n";
  const std::string layout = "table: {format: text, columns: 3}\ntime: {column: '1'}\n";
  const std::string channels = "channels: [{column: '2', joint: joint_0.0}]\n";
  EXPECT_TRUE(contains(TextSource(layout + channels, text).refusal(), {"unknown channel: joint is 'joint_0.0'"}));
  const TextSource hand(layout + channels + "kind: hand_demonstration\nhand: h.yaml\n", text);
  EXPECT_EQ(hand.read().at(0).demonstration.joint_names, std::vector<std::string>{"joint_0.0"});
  const auto glove = [&](const std::string& name, const std::string& more) {
    return parse_source(
               "name: a\nrecordings: {files: a}\ntable: {format: text, columns: 30}\ntime: none\n"
               "channels: {glove: " +
                   name + ", first_column: 8" + more + "}\n",
               "a.yaml")
        .channels;
  };
  EXPECT_EQ(glove("cyberglove_23", "").size(), 23U);
  EXPECT_EQ(glove("cyberglove_22", "").size(), 22U);
  EXPECT_EQ(glove("cyberglove_18", "").size(), 18U);
  const auto turned = glove("cyberglove_22", ", negative: [I_PIP]");
  EXPECT_EQ(turned[5].joint, "I_PIP");
  EXPECT_EQ(turned[5].column, "13");
  EXPECT_EQ(turned[5].sign, -1.0);
  EXPECT_EQ(turned[6].joint, "I_DIP");
  EXPECT_EQ(turned[7].joint, "M_MCP") << "the index abduction is the reference of a 22-sensor glove";
  EXPECT_TRUE(contains(message_of<InputError>([&] { glove("cyberglove_18", ", negative: [I_DIP]"); }), {"'I_DIP'"}));
}

TEST(TextFormat, FilesAreFoundByTheirNames) {
  const std::string layout = "table: {format: text, columns: 3}\ntime: {column: '1'}\n" + kTwo + kLabels;
  TextSource source(layout, "0 1 2\n1 3 4\n");
  spill(source.directory / "data/notes.md", "no recording");
  spill(source.directory / "data/pen_s2.txt", "0 1 2\n1 3 4\n");
  EXPECT_EQ(source.read().size(), 2U);
  const auto description = parse_source(source.yaml, "made_up.yaml");
  const auto one = read_source({source.directory / "data/pen_s2.txt"}, description);
  EXPECT_EQ(one.at(0).demonstration.labels.at("subject"), "2");
  EXPECT_TRUE(contains(message_of<InputError>([&] { read_source({source.directory / "data/notes.md"}, description); }),
                       {"notes.md", "names that match"}));
  fs::remove(source.directory / "data/cup_s1.txt");
  fs::remove(source.directory / "data/pen_s2.txt");
  EXPECT_TRUE(contains(source.refusal(), {"number of recordings in the folder is '0'"}));
}

TEST(TextFormat, BadDescriptionsAreNamed) {
  const std::string layout = "table: {format: text, columns: 3}\ntime: {column: '1'}\n";
  struct Case {
    std::string yaml;
    std::vector<std::string> message;
  };
  const std::vector<Case> cases{
      {"table: {format: excel}\n", {"made_up.yaml:3: table.format is 'excel': expected one of csv, text"}},
      {"table: {format: text}\n", {"table.columns", "how many a line has"}},
      {"table: {format: csv, variable: X}\n", {"table.variable is 'X'", "no such key but for the format matlab"}},
      {"time: never\n" + kTwo, {"time is 'never'"}},
      {"time: {column: a, rate: 5}\n" + kTwo, {"one of time.column, time.date"}},
      {"time: {date: [a, b]}\n" + kTwo, {"time.date", "year, month, day"}},
      {"time: none\ntrim: {speed: 1, window: 1}\n" + kTwo, {"trim", "no time"}},
      {layout + "unit: raw\n" + kTwo, {"channels[0].rad", "two angles"}},
      {layout + "channels: [{column: '2', joint: I_MCP, rad: [0, 1]}]\n", {"unit is not raw"}},
      {layout + "channels: [{column: '4', joint: I_MCP}]\n", {"channel is '4': expected a column number from 1 to 3"}},
      {layout + "kind: hand_demonstration\n" + kTwo, {"hand", "hand.yaml"}},
      {layout + "labels: {object: what}\n" + kTwo, {"'folder, object, subject'", "a label column 'what'"}},
      {layout + "labels: {kind: object}\n" + kTwo, {"no label 'kind'"}},
      {layout + "channels: {glove: cyberglove_22}\n", {"first_column"}},
  };
  for (const auto& bad : cases) {
    EXPECT_TRUE(contains(TextSource(bad.yaml, "0 1 2\n1 3 4\n").refusal(), bad.message)) << bad.yaml;
  }
  const auto refusal = [](const std::string& recordings) {
    return message_of<InputError>([&] { parse_source("name: a\nrecordings: " + recordings + "\n", "a.yaml"); });
  };
  EXPECT_TRUE(contains(refusal("{files: '(a', parts: [b]}"), {"a regular expression"}));
  EXPECT_TRUE(contains(refusal("{files: 'a', parts: [b]}"), {"as many groups"}));
  EXPECT_TRUE(contains(refusal("{files: 'a', index: b}"), {"recordings.index", "beside 'files'"}));
}

}  // namespace
}  // namespace opponens::storage::test
