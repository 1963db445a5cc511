// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/precision_space.hpp"

#include <utility>

#include "core/require.hpp"

namespace opponens::grasp {
namespace {

constexpr double kFieldMargin = 0.06;  // m around the object
constexpr std::size_t kFieldNodes = 1000000;

}  // namespace

PrecisionSpace make_precision_space(const robot::RobotModel& hand, const HandSurface& surface,
                                    const GraspTarget& target, const SynergyBox& box, TipModel model,
                                    const QualityConvention& convention, PrecisionGoal goal, double max_penetration) {
  require(convention.norm == WrenchNorm::l1, "precision grasps: the quality's norm must be L1");
  require(convention.cone == FrictionCone::pyramid, "precision grasps: the quality's friction cones must be pyramids");
  const Eigen::Matrix3Xd& v = target.mesh->vertices;
  const Eigen::Vector3d lower = v.rowwise().minCoeff().array() - kFieldMargin;
  const Eigen::Vector3d upper = v.rowwise().maxCoeff().array() + kFieldMargin;
  std::vector<FingerTip> tips = finger_tips(hand, surface, model);
  require(tips.size() >= 2, "precision grasps: the hand description names fewer than two tips");
  return {hand,
          surface,
          target,
          box,
          std::move(tips),
          TipField(*target.grid, lower, upper, target.grid->spacing(), kFieldNodes),
          convention,
          goal,
          max_penetration};
}

SynergyBox free_box(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  require(lower.size() == upper.size() && (upper - lower).minCoeff() >= 0.0, "free_box: lower must not exceed upper");
  SynergyBox box;
  box.center = 0.5 * (lower + upper);
  box.axes = Eigen::MatrixXd::Identity(lower.size(), lower.size());
  box.half_width = 0.5 * (upper - lower);
  box.scale = Eigen::VectorXd::Ones(lower.size());
  box.alpha = 0.0;
  box.beta = 0.0;
  return box;
}

SynergyBox free_box(const robot::RobotModel& hand) { return free_box(hand.lower(), hand.upper()); }

}  // namespace opponens::grasp
