// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/result.hpp"
#include "robot/kinematic_chain.hpp"

namespace opponens::robot {

/// Where the tip should be.
struct TipGoal {
  Eigen::Isometry3d X_RT;
  bool position_only = false;  ///< the tip's origin alone; the rotation of X_RT is not looked at
};

/// Where damped least squares came to rest.
struct Descent {
  Eigen::VectorXd q;        ///< [n] inside the limits
  double residual = 0.0;    ///< larger of the position's (m) and the rotation's (rad) distance to the goal
  bool stationary = false;  ///< no direction inside the limits brings the tip nearer: a minimum, whatever its residual
  int iterations = 0;
};

/// Bounded damped least squares from q, clipped to the limits: minimises |e|^2, e = [rotation vector rad; translation
/// m] from tip to goal. A step minimises |e - J dq|^2 + lambda |dq|^2 by QR of the stacked matrix (so that J is never
/// squared) inside the limits: joints that it takes beyond one stop there and the others are solved again, joints that
/// the gradient pushes outwards stay (active set). The damping starts at |e|^2, at most 1e-2 (after Sugihara
/// 2011, doi:10.1109/TRO.2011.2148230), and follows the ratio of actual to predicted fall (Nielsen 1999), which keeps
/// the quadratic convergence of Gauss-Newton at a regular solution; at a singular one convergence is linear. Sources:
/// Wampler 1986, doi:10.1109/TSMC.1986.289285; Buss and Kim 2005, doi:10.1080/2151237X.2005.10129202. Ends on residual
/// < tolerance, a minimum, or the count. Cost: one forward kinematics and one QR of (6 + n) x n an iteration.
Descent descend(const KinematicChain& chain, const TipGoal& goal, const Eigen::Ref<const Eigen::VectorXd>& q,
                int max_iterations, double tolerance);

struct DampedLeastSquaresSettings {
  int restarts = 40;           ///< descents, each from positions of its own
  int max_iterations = 100;    ///< of one descent
  int max_solutions = 16;      ///< after which no more descents start
  double tolerance = 5e-11;    ///< m and rad
  double apart = 0.05;         ///< rad or m: solutions all of whose joints are nearer are one
  std::uint64_t seed = 1;      ///< of the positions started from
  bool position_only = false;  ///< see TipGoal
};
/// Throws std::invalid_argument naming the field.
void validate(const DampedLeastSquaresSettings& settings);

/// Distinct positions [n] inside the limits that bring the tip to X_RT, by descents from the positions of near or, when
/// there are none, from the middle of the limits and then from uniformly random positions; in the order found. Not
/// every solution is found: a redundant chain has infinitely many, and any chain may keep one that no descent reached.
/// Deterministic. Failure: out_of_reach where X_RT lies farther away than all lengths together or every descent ended
/// in a minimum, else not_converged; both with the least residual. Throws std::invalid_argument unless X_RT is finite
/// and near fits the chain.
Result<std::vector<Eigen::VectorXd>> solve_damped(const KinematicChain& chain, const Eigen::Isometry3d& X_RT,
                                                  const std::vector<Eigen::VectorXd>& near,
                                                  const DampedLeastSquaresSettings& settings);

}  // namespace opponens::robot
