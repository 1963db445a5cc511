// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/path.hpp"

namespace opponens::motion {

struct TimingSettings {
  double velocity_scale = 0.5;  ///< share of each joint's velocity limit that is used, in (0, 1]
  double ramp = 0.5;            ///< s, time to reach full speed from rest, and back; 0: none
};
void validate(const TimingSettings& settings);  ///< throws std::invalid_argument naming field, value, constraint

/// Times of the waypoints, [N] s, from 0, strictly increasing. Along the path a parameter u runs so that at du/dt = 1
/// the slowest joint of each segment moves at velocity_scale times its limit; u(t) has a trapezoidal speed: up within
/// `ramp` seconds, cruise at 1, down within `ramp` (a triangle when the path is too short), so no joint passes its
/// limit between waypoints and the ends are at rest. Corners are passed at speed: smoothing them is not done here.
/// velocity: [d] rad/s, positive. Waypoints must be distinct from their predecessors.
Eigen::VectorXd waypoint_times(const JointPath& path, const Eigen::VectorXd& velocity, const TimingSettings& settings);

}  // namespace opponens::motion
