// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/grasp.hpp"
#include "core/synergies.hpp"
#include "grasp/grasp_target.hpp"
#include "grasp/hand_surface.hpp"
#include "grasp/precision_quality.hpp"
#include "grasp/tip_contact.hpp"
#include "grasp/tip_field.hpp"
#include "robot/robot_model.hpp"

namespace opponens::grasp {

/// Everything that a search of precision grasps reads; refers to the caller's hand, surface, target and box.
struct PrecisionSpace {
  const robot::RobotModel& hand;
  const HandSurface& surface;
  const GraspTarget& target;
  const SynergyBox& box;
  std::vector<FingerTip> tips;
  TipField field;
  QualityConvention convention;
  PrecisionGoal goal;
  double max_penetration;  ///< m, of a tip's link into the object
};

PrecisionSpace make_precision_space(const robot::RobotModel& hand, const HandSurface& surface,
                                    const GraspTarget& target, const SynergyBox& box, TipModel model,
                                    const QualityConvention& convention, PrecisionGoal goal, double max_penetration);

/// The box whose axes are the joints themselves: all of their range, [n] rad. A grasp in it is not held to synergies.
SynergyBox free_box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);
SynergyBox free_box(const robot::RobotModel& hand);  ///< the hand's joint limits

}  // namespace opponens::grasp
