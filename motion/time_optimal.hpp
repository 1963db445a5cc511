// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "motion/blended_path.hpp"

namespace opponens::motion {

/// [d] each, positive and finite.
struct RateLimits {
  Eigen::VectorXd velocity;      ///< rad/s
  Eigen::VectorXd acceleration;  ///< rad/s^2
};

/// A timed path, stored at knots. Between two knots the acceleration along the path is constant: on straight pieces the
/// motion is the parabola that positions and velocities give (cubic interpolation is exact there, straight in joint
/// space), on arcs it is off the straight line by arc_deviation at most. N knots.
struct Trajectory {
  Eigen::MatrixXd positions;   ///< [N x d] rad
  Eigen::MatrixXd velocities;  ///< [N x d] rad/s
  Eigen::MatrixXd
      accelerations;      ///< [N x d] rad/s^2, of the interval that begins here; of the last knot: that ends here
  Eigen::VectorXd times;  ///< [N] s from 0, strictly increasing
};

/// The fastest way along a path, from rest to rest and at rest where the path says so, within the limits at every knot:
/// reachability analysis (Pham and Pham 2018, doi:10.1109/TRO.2018.2819195) of x = (ds/dt)^2 on a grid. Backward, the
/// largest x from which the rest of the path can be run; forward, greedily, the largest x within that. A straight piece
/// is one step, solved in closed form (up, at constant speed, down: exact); an arc is cut into its chords, where the
/// acceleration along the path is constant and the limits are asked at both ends with the curvature there. Between, a
/// joint's rates pass them by a factor of 1 / cos(arc_step / 2) at most (0.13 %), which is taken off the limits, so
/// they are kept everywhere. Deterministic; O(pieces * d^2) at worst.
Trajectory time_optimal(const BlendedPath& path, const RateLimits& limits, const BlendSettings& settings);

/// The two one after the other, joined at rest: `second` begins where `first` ends.
Trajectory joined(const Trajectory& first, const Trajectory& second);

/// At a time within the trajectory's: cubic between knots. [3 x d]: position, velocity, acceleration.
Eigen::MatrixXd state_at(const Trajectory& trajectory, double time);

/// No motion through these waypoints, within these limits, is faster: the larger of the sum over segments of the time
/// that the slowest joint needs at full speed, and of each joint's own rest-to-rest time from the first to the last.
double least_duration(const Eigen::MatrixXd& waypoints, const RateLimits& limits);

}  // namespace opponens::motion
