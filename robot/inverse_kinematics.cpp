// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/inverse_kinematics.hpp"

#include <utility>

#include "robot/kinematic_chain.hpp"
#include "robot/ur_kinematics.hpp"

namespace opponens::robot {

InverseKinematics make_inverse_kinematics(const RobotModel& robot, const PlanningGroup& group, int tip,
                                          const DampedLeastSquaresSettings& settings) {
  validate(settings);
  KinematicChain chain = kinematic_chain(robot, group, tip);
  using Solutions = std::vector<Eigen::VectorXd>;
  auto analytic = UrKinematics::of(chain);
  if (analytic && !settings.position_only) {
    return [arm = std::move(*analytic)](const Eigen::Isometry3d& X_RT, const Solutions&) -> Result<Solutions> {
      Solutions solutions = arm.solve(X_RT);
      if (solutions.empty()) return failure(FailureCode::out_of_reach, "no branch of the arm reaches the tip's pose");
      return solutions;
    };
  }
  return [chain = std::move(chain), settings](const Eigen::Isometry3d& X_RT, const Solutions& near) {
    Result<Solutions> solutions = solve_damped(chain, X_RT, near, settings);
    if (solutions) add_turns(chain, *solutions);
    return solutions;
  };
}

InverseKinematics make_inverse_kinematics(const RobotModel& robot) {
  return make_inverse_kinematics(robot, robot.arm(), robot.palm());
}

}  // namespace opponens::robot
