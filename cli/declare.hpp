// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cli/commands.hpp"

namespace CLI {
class App;
}

namespace opponens::cli {

// Options of the command line. They are written to the referred values when it is parsed.

// That several commands have.
void add_store(CLI::App& app, Common& common);
void add_seed(CLI::App& app, std::uint64_t& seed);
void add_threads(CLI::App& app, int& threads);

// Of the commands about grasps and paths.
void declare_grasp(CLI::App& app, GraspOptions& options);
void declare_plan(CLI::App& app, PlanOptions& options);
void declare_check(CLI::App& app, CheckOptions& options);
void declare_quality(CLI::App& app, QualityOptions& options);

}  // namespace opponens::cli
