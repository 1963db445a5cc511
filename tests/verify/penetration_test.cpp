// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/penetration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/rng.hpp"
#include "robot/mesh.hpp"

namespace opponens::verify {
namespace {

Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

TEST(Penetration, BallInABox) {
  const Solid ball(robot::Sphere{0.012});
  const Solid box(robot::Box{Eigen::Vector3d(0.1, 0.1, 0.1)});
  for (const double depth : {-0.02, -1e-4, 2e-4, 1e-3, 4e-3}) {
    const Depth found = penetration(ball, box, at(0.05 + 0.012 - depth, 0.003, -0.002), 0.0);
    EXPECT_LE(found.attained, std::max(0.0, depth) + 2.1e-5) << depth;
    EXPECT_GE(found.bound, std::max(0.0, depth)) << depth;
    EXPECT_LE(found.bound, found.attained + 5e-5) << depth;
  }
  // Wholly inside, in the middle of one side: the deepest point of its surface is the one towards the middle.
  const Depth inside = penetration(ball, box, at(0.03, 0, 0), 0.0);
  EXPECT_NEAR(inside.attained, 0.05 - 0.018, 1e-4);
  // The box's surface in the ball: a face through it.
  EXPECT_NEAR(penetration(box, ball, at(-0.05 - 0.008, 0, 0), 0.0).attained, 0.004, 5e-5);
}

TEST(Penetration, EndsWhenTheBoundIsEnough) {
  const Solid ball(robot::Sphere{0.012});
  const Solid box(robot::Box{Eigen::Vector3d(0.1, 0.1, 0.1)});
  const Depth found = penetration(ball, box, at(0.0618, 0, 0), 0.001);
  EXPECT_GE(found.bound, 0.0002);
  EXPECT_LE(found.bound, 0.001);
}

TEST(Penetration, NoInsideInAnOpenMesh) {
  robot::TriangleMesh open = robot::triangulate(robot::Box{Eigen::Vector3d(0.1, 0.1, 0.1)});
  open.triangles.conservativeResize(3, open.triangles.cols() - 1);
  const Solid ball(robot::Sphere{0.012});
  EXPECT_EQ(penetration(ball, Solid(std::make_shared<const robot::TriangleMesh>(open)), at(0, 0, 0), 0.0).bound, 0.0);
}

TEST(Penetration, BoundsEverySampledPoint) {
  Rng rng = stream(5, "test/penetration");
  const robot::TriangleMesh bottle =
      robot::revolve({{0.029, 0}, {0.032, 0.004}, {0.032, 0.125}, {0.014, 0.163}, {0.015, 0.2}}, 48);
  const Solid object(std::make_shared<const robot::TriangleMesh>(bottle));
  const Solid finger(robot::Cylinder{0.012, 0.05});
  int deep = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Isometry3d X = at(rng.uniform(0.03, 0.05), rng.uniform(-0.01, 0.01), rng.uniform(0.0, 0.2));
    X.linear() =
        Eigen::AngleAxisd(rng.uniform(0, 3), Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized())
            .toRotationMatrix();
    const Depth found = penetration(finger, object, X, 0.0);
    double sampled = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const auto triangle = finger.tree().corners(
          static_cast<int>(rng.index(static_cast<std::uint64_t>(finger.mesh().triangles.cols()))));
      const double u = rng.uniform();
      const double v = rng.uniform() * (1.0 - u);
      const Eigen::Vector3d p = X * Eigen::Vector3d(triangle * Eigen::Vector3d(u, v, 1.0 - u - v));
      if (object.inside(p)) sampled = std::max(sampled, object.distance(p));
    }
    ASSERT_LE(sampled, found.bound) << X.matrix();
    ASSERT_LE(found.bound, found.attained + 5e-5 + 1e-12);
    deep += found.attained > 0.001 ? 1 : 0;
  }
  EXPECT_GT(deep, 3);
  EXPECT_LT(deep, 20);
}

}  // namespace
}  // namespace opponens::verify
