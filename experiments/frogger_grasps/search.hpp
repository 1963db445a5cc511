// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "core/synergies.hpp"
#include "experiments/frogger_grasps/scores.hpp"
#include "grasp/precision_search.hpp"

namespace opponens {

struct Comparison {
  int seeds = 20;     ///< 1 .. seeds, one grasp each
  bool table = true;  ///< as theirs had
  grasp::PrecisionSettings settings;
  std::vector<SynergyGroup> groups;  ///< the seeds take turns
};

/// Their ten published grasps sets and ours, scored alike, object by object; every grasp as a row of csv. A seed that
/// found nothing counts as quality 0. Returns on how many objects ours has both medians at least theirs.
int compare(const Folders& folders, const robot::RobotModel& hand, const Comparison& comparison, std::ostream& csv);

}  // namespace opponens
