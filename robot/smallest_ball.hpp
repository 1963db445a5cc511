// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

namespace opponens::robot {

struct EnclosingBall {
  Eigen::Vector3d center;  ///< m
  double radius;           ///< m, of the point farthest from the center, up to rounding
};

/// A ball around the points of two lists together, by a thousandth larger than the smallest at most unless rounding
/// prevents it: that of a few of them, to which the farthest is added again and again (Gaertner 1999, "Fast and robust
/// smallest enclosing balls", with the points' plain distances at the end). Cost: up to 32 passes over the points.
/// Throws std::invalid_argument when both lists are empty.
EnclosingBall enclosing_ball(std::span<const Eigen::Vector3d> points, std::span<const Eigen::Vector3d> more = {});

}  // namespace opponens::robot
