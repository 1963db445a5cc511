// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/console.hpp"
#include "cli/json.hpp"
#include "cli/planning.hpp"

namespace opponens::cli {

/// "seed 3: time_limit: ..." and, below it, why: a sentence each.
void say_failure(const Console& console, const Run& run, const Planning& planning);

/// The sentences alone; none when the run has no diagnostics.
void say_diagnostics(const Console& console, const Run& run, const Planning& planning);

/// docs/cli.md, plan: "diagnostics". null when the run has none.
Json diagnostics_json(const Run& run, const Planning& planning);

}  // namespace opponens::cli
