// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "cli/world.hpp"

namespace opponens::cli {

/// Throws InputError, in one sentence that says what to do, where no search can make sense: a hand without contact
/// points; an object without geometry, of a size that only a wrong unit explains, with an open mesh (nothing tells its
/// inside from its outside), or one that stands deep in another body.
void require_graspable(const NamedWorld& world);

/// A sentence when the object lies farther from the arm's first joint than arm and hand are long, whatever their
/// angles. Nothing: it may be reached, or the hand flies freely.
std::optional<std::string> out_of_reach(const NamedWorld& world);

}  // namespace opponens::cli
