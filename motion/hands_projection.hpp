// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"
#include "core/synergies.hpp"
#include "motion/followed_boxes.hpp"
#include "motion/syn_extend.hpp"

namespace opponens::motion {

/// A hand of q with the synergy box that it follows.
struct HandBox {
  SynergyBox box;
  PlanningGroup hand;  ///< index range in q
};

/// PROJECT for a robot that moves several hands at once (RobotModel::arms()): each hand onto its own box, the arms as
/// they are. Hands must not overlap. Otherwise as box_projection.
Projection hands_projection(const std::vector<HandBox>& hands, const Eigen::VectorXd& lower,
                            const Eigen::VectorXd& upper);

/// How far the farthest of the hands is from its box.
BoxDistance hands_distance(const std::vector<HandBox>& hands);

}  // namespace opponens::motion
