// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

namespace opponens::report {

// Published figures of "Planning grasping motions for humanoid robots" (the paper this project follows), for reading
// beside ours.

/// Table 1: accumulated sample variance in percent after k = 1..9 synergies (100 at k = 16), alpha = beta = 5 %.
struct PaperVariance {
  std::string_view name;
  std::array<double, 9> percent;
  int k;  ///< synergies needed for 95 %
};
inline constexpr std::array<PaperVariance, 5> kPaperTable1{{
    {"pre-grasp", {65.575, 77.795, 84.586, 90.316, 93.260, 95.996, 97.262, 98.165, 98.901}, 6},
    {"family 1", {79.474, 86.125, 91.442, 94.015, 96.229, 97.665, 98.315, 98.802, 99.218}, 5},
    {"family 2", {64.234, 81.877, 88.091, 92.225, 95.108, 96.781, 97.850, 98.834, 99.241}, 5},
    {"family 3", {63.280, 84.238, 91.428, 94.377, 96.394, 97.664, 98.569, 99.027, 99.467}, 5},
    {"family 4", {88.568, 91.955, 94.921, 96.606, 97.676, 98.685, 99.160, 99.449, 99.624}, 4},
}};

/// Table 2: averages over 100 executions on a 2.13 GHz PC, time limit 100 s.
struct PaperPlanning {
  std::string_view name;
  double success_percent, planning_seconds, iterations, collision_checks, valid_percent, length_rad, likeness_percent;
};
inline constexpr std::array<PaperPlanning, 3> kPaperTable2{{
    {"paper, case a (RRT-Connect)", 97, 51.80, 1834, 32231, 68.3, 14.18, 73.6},
    {"paper, case b (synergies)", 100, 6.21, 274, 10649, 80.0, 7.79, 83.1},
    {"paper, case c (mismatched synergies)", 100, 11.79, 484, 13667, 75.3, 8.35, 81.9},
}};

/// The row of Table 1 that a group may be compared with: pre-grasp, or a family named by its number ("1", "family 1",
/// "family_1"). nullptr: none.
const PaperVariance* paper_variance(std::string_view group);

}  // namespace opponens::report
