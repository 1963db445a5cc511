// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/paper_tables.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace opponens::report {
namespace {

/// The figures embedded in the program against the published table as transcribed independently.
TEST(PaperTables, TableOneEqualsTheReference) {
  const std::filesystem::path file = std::filesystem::path(OPPONENS_SHARED_DATA) / "reference" / "paper_table1.csv";
  std::ifstream in(file);
  if (!in) GTEST_SKIP() << file << " is absent";
  std::string line;
  std::getline(in, line);
  for (int k = 1; k <= 9; ++k) {
    ASSERT_TRUE(std::getline(in, line));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    int written = 0;
    ASSERT_TRUE(fields >> written);
    ASSERT_EQ(written, k);
    for (const auto& column : kPaperTable1) {
      double value = 0.0;
      ASSERT_TRUE(fields >> value);
      EXPECT_DOUBLE_EQ(value, column.percent[static_cast<std::size_t>(k - 1)]) << column.name;
    }
  }
  for (const auto& column : kPaperTable1) {
    const auto reached = std::find_if(column.percent.begin(), column.percent.end(), [](double p) { return p >= 95.0; });
    EXPECT_EQ(column.k, reached - column.percent.begin() + 1) << column.name;
  }
}

}  // namespace
}  // namespace opponens::report
