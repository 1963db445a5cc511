// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

#include "experiments/frogger_grasps/scores.hpp"

namespace opponens {

/// Scores every valid published grasp and prints, file by file, how many are force closure and how far l* and epsilon
/// are from the published values; every grasp as a row of csv. Returns how many are not force closure.
int reproduce(const Folders& folders, const robot::RobotModel& hand, std::ostream& csv);

}  // namespace opponens
