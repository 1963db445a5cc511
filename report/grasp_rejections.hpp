// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "report/html.hpp"
#include "report/report.hpp"

namespace opponens::report {

/// Trials rejected for one reason, with the bodies that are named most often behind it.
struct Rejection {
  std::string reason;
  std::int64_t trials = 0;
  std::string bodies;          ///< empty: the reason names none
  std::int64_t of_bodies = 0;  ///< trials that named these
};

/// "reason: bodies" counted by reason, the most frequent first, equal counts in order of their words.
std::vector<Rejection> by_reason(const std::map<std::string, std::int64_t>& rejected);

/// "81 % collision with shelf, 12 % out of the arm's reach, 7 % not force closure": shares of the trials by cause (by
/// reason where no causes are given), at most `shown` of them and the rest as "other reasons".
std::string rejection_words(const GraspSearch& search, std::size_t shown);

/// A bar per cause and one for the trials that were kept, with shares of all trials; nothing without trials.
Markup rejection_chart(const GraspSearch& search);

/// All causes with what may help, and all reasons with the bodies named most often; nothing when none was rejected.
Markup rejection_table(const GraspSearch& search);

}  // namespace opponens::report
