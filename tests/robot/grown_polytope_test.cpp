// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/grown_polytope.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "made_robots.hpp"

namespace opponens::robot {
namespace {

using Eigen::Vector3d;

/// A tetrahedron of support points that contains the origin, by trial.
template <typename Support>
std::array<Vector3d, 4> corners_about_origin(const Support& support, Rng& rng) {
  for (;;) {
    std::array<Vector3d, 4> corners;
    for (Vector3d& corner : corners) corner = support(random_direction(rng));
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = corners[static_cast<std::size_t>(k + 1)] - corners[0];
    if (std::abs(edges.determinant()) < 1e-3) continue;
    const Vector3d shares = edges.inverse() * -corners[0];
    if (shares.minCoeff() > 0.0 && shares.sum() < 1.0) return corners;
  }
}

TEST(GrownPolytope, FindsHowDeepTheOriginIsInABox) {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d half(rng.uniform(0.5, 1.5), rng.uniform(0.5, 1.5), rng.uniform(0.5, 1.5));
    const Vector3d center =
        half.cwiseProduct(Vector3d(rng.uniform(-0.9, 0.9), rng.uniform(-0.9, 0.9), rng.uniform(-0.9, 0.9)));
    const auto support = [&](const Vector3d& n) -> Vector3d {
      return center +
             Vector3d(std::copysign(half.x(), n.x()), std::copysign(half.y(), n.y()), std::copysign(half.z(), n.z()));
    };
    const double depth = (half - center.cwiseAbs()).minCoeff();
    const std::array<Vector3d, 4> corners = corners_about_origin(support, rng);
    EXPECT_TRUE(comes_to_hold_ball(corners, 0.999 * depth, support)) << i;
    EXPECT_FALSE(comes_to_hold_ball(corners, 1.001 * depth, support)) << i;
  }
}

TEST(GrownPolytope, NeverHoldsMoreThanARoundSolidDoes) {
  Rng rng(2);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d center = rng.uniform(0.0, 0.95) * random_direction(rng);
    const auto support = [&](const Vector3d& n) -> Vector3d { return center + n.normalized(); };
    const double depth = 1.0 - center.norm();
    const std::array<Vector3d, 4> corners = corners_about_origin(support, rng);
    EXPECT_FALSE(comes_to_hold_ball(corners, 1.001 * depth, support)) << i;
    found += comes_to_hold_ball(corners, 0.3 * depth, support) ? 1 : 0;
  }
  EXPECT_GT(found, 1500);  // ten corners beyond the first four leave a round solid mostly that deep
}

TEST(GrownPolytope, FlatCornersAreRefused) {
  const auto support = [](const Vector3d& n) -> Vector3d {
    return {std::copysign(1.0, n.x()), std::copysign(1.0, n.y()), 0.0};
  };
  const std::array<Vector3d, 4> flat{Vector3d(1, 1, 0), Vector3d(-1, 1, 0), Vector3d(-1, -1, 0), Vector3d(1, -1, 0)};
  EXPECT_FALSE(comes_to_hold_ball(flat, 1e-6, support));
  const std::array<Vector3d, 4> point{Vector3d(1, 1, 0), Vector3d(1, 1, 0), Vector3d(1, 1, 0), Vector3d(1, 1, 0)};
  EXPECT_FALSE(comes_to_hold_ball(point, 1e-6, support));
}

}  // namespace
}  // namespace opponens::robot
