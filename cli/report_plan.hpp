// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "report/report.hpp"
#include "storage/store.hpp"

namespace opponens::cli {

/// The newest path of the newest plan command, and the runs of each planner's newest plan command for the same world
/// and grasps. plans: newest first (made_from).
std::optional<report::PathPart> path_part(const storage::Store& store, const std::vector<storage::IndexEntry>& plans);

/// The run log, and from it the planners' times: everything that differs from run to run.
report::RunPart run_part(const storage::Store& store);

}  // namespace opponens::cli
