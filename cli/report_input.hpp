// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "report/report.hpp"
#include "storage/store.hpp"

namespace opponens::cli {

/// Gathers what the report shows: the newest synergies, the newest grasps and path made from them, the newest verdicts,
/// and the chain behind them. A stage that is missing stays empty.
report::ReportInput report_input(const storage::Store& store);

}  // namespace opponens::cli
