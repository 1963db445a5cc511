// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "cli/stored.hpp"
#include "report/report.hpp"

namespace opponens::cli {

/// The grasps that were made from a synergy set in one world, the best first, and what the searches of each group came
/// to. verdicts: of the newest verification, by id; a grasp without one was not checked.
report::GraspPart report_grasps(const storage::Store& store, const Stored<SynergySet>& synergies, const WorldKey& world,
                                const robot::Scene& scene, const std::map<std::string, bool>& verdicts);

}  // namespace opponens::cli
