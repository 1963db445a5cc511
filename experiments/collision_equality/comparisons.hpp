// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "core/rng.hpp"
#include "robot/collision.hpp"

namespace opponens::experiments {

/// What a comparison counted.
struct Tally {
  std::int64_t configurations = 0;
  std::int64_t free = 0;
  std::int64_t different = 0;
  std::int64_t pairs_asked = 0;  ///< of the truth, by the two-stage checker; not counted for a flying hand
  std::string example;           ///< a configuration with different verdicts, 17 digits
};

/// A robot in a scene; the same with the checker that does without AVX2.
struct Subject {
  const robot::RobotModel& robot;
  const robot::Scene& scene;
  robot::CollisionChecker checker{robot, scene};
  robot::CollisionChecker portable{robot, scene, {}, {.portable = true}};

  Subject(const robot::RobotModel& model, const robot::Scene& around) : robot(model), scene(around) {}
};

// Each compares the two-stage verdicts (in batches with and without AVX2, and one by one) with the truth, on `count`
// configurations or a few more.

/// Uniform within the limits.
Tally compare_uniform(const Subject& subject, std::int64_t count, Rng& rng);
/// Spread by 0.02 rad (largest joint step) over straight motions of up to 1 rad.
Tally compare_motions(const Subject& subject, std::int64_t count, Rng& rng);
/// Both ends of segments of at most 1e-6 rad between a free and a colliding configuration, found by bisecting straight
/// motions with the truth. Few, or none, where the two hardly occur together.
Tally compare_contacts(const Subject& subject, std::int64_t count, Rng& rng);
/// A hand alone, its palm within 0.15 m of a random point of a body's box, or within 0.4 m of the usual root in an
/// empty scene.
Tally compare_flying(const Subject& hand, std::int64_t count, Rng& rng);
/// The same, moved along a line until two poses at most 1e-6 m apart differ.
Tally compare_flying_contacts(const Subject& hand, std::int64_t count, Rng& rng);

}  // namespace opponens::experiments
