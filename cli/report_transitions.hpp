// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cli/json.hpp"
#include "cli/stored.hpp"
#include "report/report.hpp"

namespace opponens::cli {

/// The report's part about phase transitions: `found` is the document of analyze, method the rule in force.
report::TransitionPart transition_part(const std::vector<Stored<Demonstration>>& motions, const Json& found,
                                       const std::string& method);

}  // namespace opponens::cli
