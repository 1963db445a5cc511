// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/table2_planning/cases.hpp"

namespace opponens::table2 {

/// An estimate with its 95 % interval: percentile bootstrap, 10,000 resamples of whole seeds (Efron 1979,
/// doi:10.1214/aos/1176344552).
struct Estimate {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct Column {
  int count = 0;  ///< of the seeds that have a value
  std::optional<Estimate> median, mean;
};
Column column_of(const std::vector<double>& values);

/// A planner's row. Times, iterations, checks and valid segments over all runs (failed ones at their budget), lengths
/// and human-likeness over the solved ones.
struct Summary {
  std::string planner;
  double range = 0.0;
  int runs = 0, solved = 0, verified = 0, verified_of = 0, grasp_groups = 0;
  Column cpu_ms, iterations, checks, all_checks, valid_percent, length, length_l1, arm_length, hand_length, likeness;
  Column time_ratio;       ///< planning over checking the returned path alone
  double cpu_ms_99 = 0.0;  ///< 99 % quantile
};
Summary summarize(const std::vector<Record>& records, const std::string& planner, double range);

/// Differences of a planner from another one on the same seeds. Ratios are geometric means of the paired ratios;
/// lengths and likeness over the seeds that both solved.
struct Comparison {
  std::string planner, baseline;
  int pairs = 0, solved_pairs = 0;
  std::optional<Estimate> checks_ratio;       ///< of the search
  std::optional<Estimate> checks_mean_ratio;  ///< mean over mean
  std::optional<Estimate> all_checks_ratio;   ///< confirmation included
  std::optional<Estimate> cpu_ratio, length_difference, length_ratio, likeness_difference;
  std::optional<Estimate> length_l1_ratio;  ///< of the sums of all joints' movements
};
Comparison compare(const std::vector<Record>& records, const std::string& planner, const std::string& baseline);

/// The range with the most solved runs, and among those with the least median of checks. records: of one planner at
/// several ranges.
double best_range(const std::vector<Record>& records, const std::string& planner);

}  // namespace opponens::table2
