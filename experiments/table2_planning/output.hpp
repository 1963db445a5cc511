// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/table2_planning/runs.hpp"
#include "experiments/table2_planning/summary.hpp"

namespace opponens::table2 {

/// Everything that one call of the experiment found.
struct Report {
  std::string scene, robot, grasps, likeness_reference;
  RunSettings tuned_with, reported_with;
  std::vector<Summary> tried;  ///< every planner at every range, on the tuning seeds
  std::vector<Summary> rows;   ///< every planner at its best range, on fresh seeds
  std::vector<Comparison> comparisons;
  Queries queries;
};

/// One line per run.
std::string csv_of(const std::vector<Record>& records);
/// Without times it is the same whatever the machine and the number of threads.
std::string json_of(const Report& report);
/// Table 2 beside the paper's, the ranges tried, and the comparisons.
std::string markdown_of(const Report& report);

/// Throws InputError when it cannot be written.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace opponens::table2
