// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/rng.hpp"

namespace opponens::grasp {

/// Three independent standard normal deviates. They are drawn in an order of ours, the last first: the order in which
/// a call's arguments are evaluated is the compiler's, and the same seed must give the same grasps with each.
inline Eigen::Vector3d normal_vector(Rng& rng) {
  Eigen::Vector3d v;
  for (const int i : {2, 1, 0}) v[i] = rng.normal();
  return v;
}

}  // namespace opponens::grasp
