// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "analysis/simulate.hpp"

namespace opponens::cli {

/// Reads models/human/grasp_types.yaml, or a file of its form. Throws InputError naming file, line and field.
analysis::SimulationModel load_simulation_model(const std::filesystem::path& file);

}  // namespace opponens::cli
