// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "cli/stored.hpp"
#include "cli/world.hpp"
#include "core/path.hpp"
#include "verify/paths.hpp"

namespace opponens::cli {

/// What a stored path claims, by the grasps that it names: for every arm that its world drives one of that arm's, with
/// that arm's object, in the same files. motion: as stored. nullopt, and the verdict says why, when there is no such
/// grasp.
std::optional<opponens::verify::PathClaim> path_claim(const storage::Store& store, const storage::Record& record,
                                                      const NamedWorld& world, const JointPath& motion,
                                                      opponens::verify::Verdict& verdict);

}  // namespace opponens::cli
