// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// What all recordings together decide about each.
#include "tests/storage/text_source.hpp"

namespace opponens::storage::test {
namespace {

TEST(Channels, WhatIsDroppedIsDecidedOnWhatIsStored) {
  // M_MCP moves only before the time at which trimming begins to keep: it is stuck in what is stored.
  std::string text;
  for (int i = 0; i < 20; ++i) {
    text += std::to_string(i) + " " + std::to_string(i < 10 ? 0 : i) + " " +
            std::to_string(i < 3 ? 0.001 * i : 0.5e-2) + "\n";
  }
  const std::string yaml =
      "table: {format: text, columns: 3}\ntime: {column: '1'}\nchannels: [{column: '2', joint: I_MCP}, {column: '3', "
      "joint: M_MCP}]\ntrim: {speed: 0.5, window: 1}\n";
  EXPECT_EQ(TextSource(yaml, text).read().at(0).demonstration.joint_names.size(), 2U);
  const auto found = TextSource(yaml + "stuck: drop\n", text).read();
  EXPECT_EQ(found.at(0).demonstration.joint_names, std::vector<std::string>{"I_MCP"});
  EXPECT_EQ(found[0].file.dropped, std::vector<std::string>{"M_MCP"});
}

TEST(Channels, ARecordingTellsWhatItsCountsWereComparedWith) {
  TextSource source(
      "table: {format: text, columns: 3}\ntime: {column: '1'}\nunit: raw\nraw_range: {observed_in: {subject: '2'}}\n"
      "channels: [{column: '2', joint: I_MCP, rad: [0, 1], raw: [0, 9]}, {column: '3', joint: I_PIP, rad: [0, 1]}]\n" +
          kLabels,
      "0 1 2\n1 3 4\n");
  spill(source.directory / "data/cup_s2.txt", "0 1 20\n1 3 70\n");
  const auto read = source.read();
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].file.observed_range, (std::map<std::string, Pair>{{"I_PIP", {20, 70}}}));
  EXPECT_TRUE(read[0].file.companions.contains("cup_s2.txt"));
  spill(source.directory / "data/cup_s2.txt", "0 1 20\n1 3 80\n");
  const auto again = source.read();
  EXPECT_EQ(again[0].file.sha256, read[0].file.sha256);
  EXPECT_NE(again[0].file.calibrated_by, read[0].file.calibrated_by);
  EXPECT_EQ(again[0].file.observed_range.at("I_PIP")[1], 80);
}

TEST(Interruption, EndsAnyPassOverTheFiles) {
  const TextSource source("table: {format: text, columns: 3}\ntime: {column: '1'}\nstuck: drop\n" + kTwo,
                          "0 1 2\n1 3 4\n");
  const auto description = parse_source(source.yaml, "made_up.yaml");
  int asked = 0;
  const auto read = [&](int stop) {
    asked = 0;
    read_source(
        {source.directory / "data"}, description, [](Recording&&) {}, [&] { return ++asked == stop; });
  };
  EXPECT_NO_THROW(read(0));
  EXPECT_EQ(asked, 2);  // the survey, and the reading
  EXPECT_THROW(read(1), ReadingInterrupted);
  EXPECT_THROW(read(2), ReadingInterrupted);
}

}  // namespace
}  // namespace opponens::storage::test
