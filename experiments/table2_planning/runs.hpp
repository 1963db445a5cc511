// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/table2_planning/cases.hpp"
#include "experiments/table2_planning/problem.hpp"

namespace opponens::table2 {

/// A case at one of its ranges.
struct Trial {
  Case what;
  double range = 0.4;  ///< rad
};

struct RunSettings {
  std::uint64_t first_seed = 1;
  int seeds = 100;
  std::int64_t budget = 200000;  ///< configurations per run, those of confirming included
  int threads = 1;
  double verified_share = 1.0;  ///< of the seeds whose paths are proven (the first ones)
  Jitter jitter;
};

/// What the queries were like.
struct Queries {
  int seeds = 0;
  int bases_rejected = 0;        ///< drawn again, as the start was not free
  std::vector<int> unreachable;  ///< [grasps] seeds whose base does not reach it
  double goals = 0.0;            ///< mean number of goal configurations
};

struct Results {
  std::vector<Record> records;  ///< by seed, then by trial
  Queries queries;
};

/// Runs every trial for every seed, on that seed's query. The results do not depend on the number of threads (their
/// times do).
Results run_all(const Setting& setting, const std::vector<Trial>& trials, const RunSettings& settings);

}  // namespace opponens::table2
