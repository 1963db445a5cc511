// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "core/rng.hpp"
#include "robot/joint_mapping.hpp"
#include "robot/tip_targets.hpp"

namespace opponens::robot {

namespace {

constexpr int kPostures = 100;
constexpr int kIterations = 500;

/// Postures [d x kPostures] rad, uniform in the joint ranges.
Eigen::MatrixXd postures_of(const RobotModel& human) {
  Rng rng = stream(1, "align_hands");
  Eigen::MatrixXd q(human.dof(), kPostures);
  for (Eigen::Index t = 0; t < q.cols(); ++t) {
    for (int i = 0; i < human.dof(); ++i) q(i, t) = rng.uniform(human.lower()[i], human.upper()[i]);
  }
  return q;
}

/// The mean ratio of finger lengths, and the offset that lays the middle of the finger bases on each other.
HandAlignment by_fingers(const std::vector<FingerPair>& fingers, const Eigen::Matrix3d& R_robot_human) {
  const auto count = static_cast<double>(fingers.size());
  HandAlignment alignment{0.0, Eigen::Vector3d::Zero()};
  for (const FingerPair& pair : fingers) alignment.scale += pair.robot.length / pair.human.length / count;
  for (const FingerPair& pair : fingers) {
    alignment.offset += (pair.robot.base - alignment.scale * R_robot_human * pair.human.base) / count;
  }
  return alignment;
}

}  // namespace

Result<HandAlignment> align_hands(const RobotModel& human, const RobotModel& hand, const HandMapping& mapping) {
  const auto fingers = mapped_fingers(human, hand, mapping);
  if (!fingers) return tl::make_unexpected(fingers.error());
  if (fingers->empty()) return failure(FailureCode::degenerate, "the mapping names no fingertip to align the hands by");
  HandAlignment alignment = by_fingers(*fingers, mapping.R_robot_human);
  const Eigen::MatrixXd q_human = postures_of(human);
  Eigen::MatrixXd q = hand.clip(Eigen::VectorXd::Zero(hand.dof())).replicate(1, q_human.cols());
  BoolMatrix clamped = BoolMatrix::Constant(q.rows(), q.cols(), false);
  for (const auto* copies : {&mapping.copied, &mapping.direct}) {
    if (const auto copied = copy_joints(human, q_human, hand, *copies, q, clamped); !copied) {
      return tl::make_unexpected(copied.error());
    }
  }
  FingertipFit fit;
  fit.targets = aligned_targets(human, q_human, alignment, mapping.R_robot_human, *fingers);
  fit.fitted = moving_joints(*fingers);
  fit.rest = q(fit.fitted, Eigen::all);
  fit.cylindrical = false;
  fit.shifted = true;
  fit.tolerance = 1e-4;
  RetargetSettings settings = default_settings(MappingKind::fingertip);
  settings.max_iterations = kIterations;
  const auto fitted = fit_fingertips(hand, fit, settings, q);
  if (!fitted) return tl::make_unexpected(fitted.error());
  if (!fitted->converged) return failure(FailureCode::not_converged, "the alignment of the hands did not converge");
  alignment.offset += fitted->shift;
  return alignment;
}

}  // namespace opponens::robot
