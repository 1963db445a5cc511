// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "core/synergies.hpp"
#include "grasp/grasp_search.hpp"
#include "grasp/precision_search.hpp"

namespace opponens::cli {

/// The options of `grasp` as the search's settings.
grasp::SearchSettings search_settings(const GraspOptions& options, int threads);

/// The same for precision grasps, without a convention of quality.
grasp::PrecisionSettings precision_settings(const GraspOptions& options, int threads);

/// The same as they are recorded with what they made.
Json settings_json(const GraspOptions& options);

/// The groups that --group names. Throws InputError when there is none, or one without synergies is to be searched.
std::vector<SynergyGroup> chosen_groups(const SynergySet& set, const GraspOptions& options);

}  // namespace opponens::cli
