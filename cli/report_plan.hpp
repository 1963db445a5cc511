// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "report/report.hpp"
#include "storage/store.hpp"

namespace opponens::cli {

/// Id of what the page's world comes from: the newest plan command's record, else the newest path, else the newest
/// grasp; empty when there is none.
std::string newest_result(const storage::Store& store);

/// The newest path of the newest plan command, and the runs of each planner's newest plan command for the same world
/// and grasps. Stores without such records (of version 0.1 and before): the newest path alone.
std::optional<report::PathPart> path_part(const storage::Store& store);

/// The run log, and from it the planners' times: everything that differs from run to run.
report::RunPart run_part(const storage::Store& store);

}  // namespace opponens::cli
