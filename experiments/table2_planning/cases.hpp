// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/path.hpp"
#include "experiments/table2_planning/ompl_baselines.hpp"
#include "experiments/table2_planning/problem.hpp"

namespace opponens::table2 {

/// What is compared: a planner with what is changed of its settings.
struct Case {
  std::string name;  ///< as given
  std::optional<motion::Variant> variant;
  std::optional<OmplPlanner> ompl;
  bool deranged = false;         ///< every family follows the box of another, drawn per seed
  double full_space = 0.05;      ///< PlannerSettings::full_space_probability
  double widen = 1.0;            ///< factor of the boxes' half widths
  std::optional<int> synergies;  ///< boxes of so many synergies, half widths of two standard deviations beyond the kept
  bool exact = false;            ///< asks FCL alone, one configuration at a time
};

/// "a", "b", "c", "d", "e", "ompl_rrtconnect", "ompl_lbkpiece1", "ompl_bitrrt", each with any of "+full=P", "+widen=F",
/// "+k=N", "+exact" after it. Throws InputError.
Case parse_case(const std::string& text);

/// One run, as the table counts it. nullopt: the planner has no such thing, or there is no path.
struct Record {
  std::string planner;
  double range = 0.0;  ///< rad
  std::uint64_t seed = 0;
  bool solved = false;
  std::string status;
  int goals = 0;
  std::string group;  ///< of the grasp reached
  double cpu_seconds = 0.0;
  std::optional<std::int64_t> iterations;
  std::int64_t checks = 0;          ///< of the search: without those that confirm the answer
  std::int64_t confirm_checks = 0;  ///< of World::confirm
  std::optional<double> valid_segments;
  std::optional<double> length, length_l1, arm_length, hand_length, likeness;
  std::optional<double> path_seconds;  ///< CPU to check the returned path alone, same checker and spacing
  std::optional<bool> verified;        ///< nullopt: not asked
  std::optional<double> clearance;     ///< m, the worst that verification found
  std::string reason;                  ///< why verification failed
};

/// One run of a case at a range (rad); path holds the answer up to the pre-grasp, goal its index.
struct Answer {
  Record record;
  JointPath path;
  int goal = -1;
};
Answer run_case(const Case& what, const Problem& problem, double range, std::int64_t budget);

}  // namespace opponens::table2
