// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/demonstration.hpp"

namespace opponens::analysis {

/// Joint velocities [T x n] rad/s of a recording, T >= 2: at each sample the slope of the parabola through it and its
/// neighbours (at the ends through the nearest three; of the line for T = 2). Exact for motions of second degree, at
/// any spacing; the error is of second order in the spacing (Fornberg 1988, doi:10.1090/S0025-5718-1988-0935077-0, for
/// three nodes). First-order synergies (the paper's future work) are the principal axes of these. Throws
/// std::invalid_argument for fewer than 2 samples or time that does not increase.
Eigen::MatrixXd joint_velocities(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::MatrixXd>& q_h);

/// Standard deviation in rad/s that white sensor noise of 1 rad gives a velocity, at the recording's median spacing d:
/// 1 / (sqrt(2) d). What a resolution in rad becomes in rad/s.
double velocity_noise_gain(const Eigen::VectorXd& time);

}  // namespace opponens::analysis
