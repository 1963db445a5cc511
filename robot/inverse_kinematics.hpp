// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/result.hpp"
#include "robot/damped_least_squares.hpp"
#include "robot/robot_model.hpp"

namespace opponens::robot {

/// Positions [n] of a planning group that bring a link, the tip T, to a pose in the root frame. Contract:
/// - every position is finite, inside the limits and meets X_RT within 1e-10 (m and rad); the list is not empty;
/// - near, where not empty: positions of the group next to which solutions are wanted. A solver that does not find all
///   solutions anyhow starts there, and only there, one solution for each (fewer where several lead to the same).
///   Empty: all solutions, or as many as the solver looks for; a position appears in every turn inside the limits;
/// - Failure: out_of_reach, or not_converged where the solver cannot tell; the detail has the least residual;
/// - throws std::invalid_argument unless X_RT is finite and a rotation;
/// - equal arguments give equal bits; safe to share between threads.
using InverseKinematics = std::function<Result<std::vector<Eigen::VectorXd>>(const Eigen::Isometry3d& X_RT,
                                                                             const std::vector<Eigen::VectorXd>& near)>;

/// For any group and link: analytic (UrKinematics) where the chain between root and link is an arm of the UR family,
/// else damped least squares (solve_damped) with these settings. A position-only goal is always the latter's. The
/// result keeps its own copy of the chain. Throws std::invalid_argument when no joint of the group moves the link.
InverseKinematics make_inverse_kinematics(const RobotModel& robot, const PlanningGroup& group, int tip,
                                          const DampedLeastSquaresSettings& settings = {});

/// For the arm group and the palm.
InverseKinematics make_inverse_kinematics(const RobotModel& robot);

}  // namespace opponens::robot
