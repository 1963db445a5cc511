// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/path.hpp"
#include "motion/followed_boxes.hpp"
#include "motion/world.hpp"

namespace opponens::motion {

struct ShortcutSettings {
  int iterations = 100;  ///< pairs of points tried; the only limit
};
void validate(const ShortcutSettings& settings);

struct Shortcut {
  JointPath path;
  double length_before = 0.0;  ///< rad, weighted metric
  double length = 0.0;         ///< rad, never above length_before
  int accepted = 0;
  std::int64_t collision_checks = 0;
};

/// Random shortcutting (Geraerts and Overmars 2007, doi:10.1177/0278364907079280, section 3): pairs of waypoints and
/// pairs of points between them are joined straight where that is shorter and valid, by World::first_invalid and, when
/// given, World::confirm. Every motion of the result has been asked for, or is one of the given path, which must be
/// valid; ends are kept. Own random stream: same arguments, same path. Without boxes a shortcut is straight in the full
/// space: it may leave the synergy boxes that the path followed.
Shortcut shortcut(const JointPath& path, const Eigen::VectorXd& weights, const World& world,
                  const ShortcutSettings& settings, std::uint64_t seed);

/// The same, keeping the law of FollowedBoxes, which the given path must keep. Between two points of one part the
/// straight motion keeps it by itself, boxes being convex; where the straight motion would pass from one box to the
/// other out of both, it gets a waypoint at a random share of it with the hands drawn towards the bridge's until they
/// are within both limits (docs/algorithms/planner.md, docs/deviations.md, 17). kept: the arms' index range in q.
Shortcut shortcut_in_boxes(const JointPath& path, const Eigen::VectorXd& weights, const World& world,
                           const FollowedBoxes& boxes, const PlanningGroup& kept, std::uint64_t seed);

}  // namespace opponens::motion
