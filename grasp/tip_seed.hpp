// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/rng.hpp"
#include "grasp/precision_problem.hpp"

namespace opponens::grasp {

/// A hand about to pinch the object: a chord through the object from a surface point (uniform by area) along the inward
/// normal, tilted by up to 0.35 rad; of twelve hand shapes (synergy coordinates triangular over the box) the one whose
/// opening between the opposing tip and the middle of the others fits the chord best; opposing tip at one end, the
/// others at the other, the hand turned about the chord at random. nullopt: ten chords failed, none leaves the object
/// within 0.3 m.
std::optional<HandSeed> draw_tip_seed(const PrecisionSpace& space, Rng& rng);

/// Of `draws` seeds the one nearest to a grasp: the least sum of |gaps| and positive excess less quality (at least -1).
/// nullopt when none was found.
std::optional<HandSeed> best_tip_seed(const PrecisionSpace& space, PrecisionProblem& problem, int draws, Rng& rng);

/// The tip that opposes the others: named "thumb", or else the one farthest from their middle at the box's centre.
std::size_t opposing_tip(const PrecisionSpace& space);

}  // namespace opponens::grasp
