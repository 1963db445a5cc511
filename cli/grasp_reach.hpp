// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cli/world.hpp"
#include "core/grasp.hpp"
#include "motion/contact_depth.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"

namespace opponens::cli {

/// Algorithm 1, lines 6 and 7, as the search's acceptance test. Refers to the world, which must outlive it.
class Reach {
 public:
  /// max_penetration: m, of the contacts along the closing segment.
  Reach(const NamedWorld& world, double max_penetration);

  /// Fills grasp.arm_solutions; the reason when there is none. Thread-safe.
  std::string operator()(Grasp& grasp) const;

  const robot::CollisionChecker& checker() const { return free_space_; }

 private:
  const NamedWorld& world_;
  double max_penetration_;
  robot::InverseKinematics kinematics_;
  robot::CollisionChecker free_space_;
  robot::CollisionChecker closing_;
  motion::ContactDepth depth_;
  Eigen::Isometry3d X_RO_;
};

}  // namespace opponens::cli
