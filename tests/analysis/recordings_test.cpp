// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Real glove recordings are singular almost always; they must be split and analysed all the same.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "analysis/analyze.hpp"

namespace opponens::analysis {
namespace {

Demonstration read_csv(const std::filesystem::path& file) {
  Demonstration result;
  result.id = file.stem().string();
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::string cell;
  for (std::stringstream header(line); std::getline(header, cell, ',');) {
    if (cell != "t_s") result.joint_names.push_back(cell);
  }
  std::vector<double> values;
  while (std::getline(in, line)) {
    for (std::stringstream row(line); std::getline(row, cell, ',');) values.push_back(std::stod(cell));
  }
  const auto columns = static_cast<Eigen::Index>(result.joint_names.size()) + 1;
  const auto rows = static_cast<Eigen::Index>(values.size()) / columns;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor table = Eigen::Map<const RowMajor>(values.data(), rows, columns);
  result.time = table.col(0);
  result.q_h = table.rightCols(columns - 1);
  // s1_scissors_r1: subject, object, repetition.
  const auto first = result.id.find('_');
  const auto last = result.id.rfind('_');
  result.labels["subject"] = result.id.substr(0, first);
  result.labels["object"] = result.id.substr(first + 1, last - first - 1);
  return result;
}

TEST(Recordings, WestR2gIsSplitAndAnalysedWithoutFailure) {
  const std::filesystem::path folder = std::filesystem::path(OPPONENS_SHARED_DATA) / "data/demos/west_r2g/csv";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings at " << folder;
  std::vector<Demonstration> recordings;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) recordings.push_back(read_csv(entry.path()));
  ASSERT_EQ(recordings.size(), 100u);
  AnalysisSettings settings;
  settings.group_by = "object";
  const Result<Analysis> analysis = analyze(recordings, settings);
  ASSERT_TRUE(analysis) << analysis.error().detail;
  EXPECT_EQ(analysis->synergies.grasp.size(), 5u);
  for (const TransitionReport& transition : analysis->transitions) {
    EXPECT_FALSE(transition.dropped_channels.empty()) << transition.demonstration;
    EXPECT_GT(transition.likeness.fraction, 0.0);
    EXPECT_LT(transition.likeness.fraction, 1.0);
  }
  for (const GroupReport& group : analysis->groups) {
    EXPECT_EQ(group.cluster, "subject");
    EXPECT_EQ(group.clusters, 5);
  }
  // The three finger abductions are exactly dependent, over all recordings too.
  for (const SynergyGroup& group : analysis->synergies.grasp) {
    const auto& dropped = group.dropped_channels;
    EXPECT_TRUE(std::any_of(dropped.begin(), dropped.end(), [](const auto& name) { return name.ends_with("_ABD"); }));
    EXPECT_EQ(group.dof_effective + static_cast<int>(dropped.size()), 23);
  }
}

}  // namespace
}  // namespace opponens::analysis
