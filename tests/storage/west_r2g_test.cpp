// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/codec.hpp"
#include "storage/readers/source.hpp"
#include "tests/storage/support.hpp"

namespace opponens::storage::test {
namespace {

const fs::path kData = fs::path(OPPONENS_SHARED_DATA) / "data/demos/west_r2g";
const fs::path kSource = fs::path(OPPONENS_SOURCE_DIR) / "models/sources/west_r2g.yaml";

TEST(WestR2g, DescriptionLoads) {
  const SourceDescription source = load_source(kSource);
  EXPECT_EQ(source.channels.size(), 23U);
  EXPECT_EQ(source.calibrate_by, "subject");
  EXPECT_EQ(source.resample_rate, 50.0);
}

TEST(WestR2g, AllRecordings) {
  if (!fs::exists(kData)) GTEST_SKIP() << kData << " is absent";
  const std::vector<Recording> reading = read_source({kData}, load_source(kSource));
  ASSERT_EQ(reading.size(), 100U);
  Summary summary;
  for (const auto& recording : reading) add(summary, recording);
  EXPECT_EQ(summary.recordings_per_label.at("object").size(), 5U);
  for (const auto& [object, count] : summary.recordings_per_label.at("object")) EXPECT_EQ(count, 20) << object;
  for (const auto& [subject, count] : summary.recordings_per_label.at("subject")) EXPECT_EQ(count, 20) << subject;
  EXPECT_NEAR(summary.lowest_rate, 50.0, 1e-9);
  EXPECT_NEAR(summary.highest_rate, 50.0, 1e-9);
  std::map<std::string, int> stuck;  // as the files themselves are
  for (const auto& channel : summary.channels) {
    if (channel.stuck_recordings > 0) stuck[channel.name] = channel.stuck_recordings;
  }
  EXPECT_EQ(stuck, (std::map<std::string, int>{{"W_PITCH", 1}, {"W_YAW", 2}}));
  for (const auto& [demonstration, report] : reading) {
    EXPECT_NEAR(report.trimmed_start + report.trimmed_end + 0.02 * (report.samples - 1), report.duration, 1e-9);
  }
  // The signs of the description: fingers bend and the thumb opposes from the first to the last sample, on average.
  std::map<std::string, double> change;
  for (const auto& [demonstration, report] : reading) {
    const auto last = demonstration.q_h.rows() - 1;
    for (std::size_t j = 0; j < demonstration.joint_names.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      change[demonstration.joint_names[j]] += (demonstration.q_h(last, column) - demonstration.q_h(0, column)) / 100.0;
    }
  }
  for (const char* joint : {"T_ROT", "T_MCP", "T_ABD", "I_MCP", "I_PIP", "I_DIP", "M_MCP", "M_PIP", "M_DIP", "R_MCP",
                            "R_PIP", "R_DIP", "L_MCP", "L_PIP", "L_DIP"}) {
    EXPECT_GT(change.at(joint), 0.03) << joint;
  }
  for (const char* joint : {"I_ABD", "R_ABD", "L_ABD"}) EXPECT_LT(change.at(joint), -0.1) << joint;

  const TemporaryDirectory directory;
  Store store(directory / "store", true);
  std::vector<Record> records;
  for (const auto& recording : reading) records.push_back(encode(recording.demonstration, {}));
  const auto ids = store.commit(records);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(decode_demonstration(store.read(ids[i])).q_h, reading[i].demonstration.q_h);
  }
}

}  // namespace
}  // namespace opponens::storage::test
