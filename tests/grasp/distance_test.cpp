// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "allegro.hpp"
#include "core/rng.hpp"
#include "grasp/body_distance.hpp"
#include "grasp/distance_grid.hpp"
#include "grasp/grasp_target.hpp"
#include "robot/mesh.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

BodyDistance body(const robot::Shape& shape) { return BodyDistance({{shape, Eigen::Isometry3d::Identity()}}); }

Vector3d random_point(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

TEST(BodyDistance, ByHand) {
  const BodyDistance box = body(robot::Box{Vector3d(2, 4, 6)});
  EXPECT_NEAR(box.query(Vector3d(4, 0, 0), 10).value, 3.0, 1e-15);
  EXPECT_NEAR(box.query(Vector3d(4, 6, 0), 10).value, 5.0, 1e-15);
  EXPECT_NEAR(box.query(Vector3d(0.5, 0, 0), 10).value, -0.5, 1e-15);
  const BodyDistance cylinder = body(robot::Cylinder{1.0, 2.0});
  EXPECT_NEAR(cylinder.query(Vector3d(4, 0, 5), 10).value, 5.0, 1e-15);
  EXPECT_NEAR(cylinder.query(Vector3d(0, 0, 0.9), 10).value, -0.1, 1e-15);
  EXPECT_NEAR(cylinder.query(Vector3d(0, 0.8, 0), 10).value, -0.2, 1e-15);
  EXPECT_NEAR(body(robot::Sphere{0.5}).query(Vector3d(0, 2, 0), 10).value, 1.5, 1e-15);
  EXPECT_TRUE(std::isinf(BodyDistance({}).query(Vector3d::Zero(), 1).value));
  EXPECT_GE(body(robot::Sphere{0.5}).query(Vector3d(0, 20, 0), 1).value, 1.0);  // a lower bound beyond the horizon
}

TEST(BodyDistance, PrimitivesEqualTheirMeshesAndGradientsTheirDifferences) {
  Rng rng = stream(41, "body");
  const robot::Shape shape = robot::Box{Vector3d(0.1, 0.2, 0.05)};
  Eigen::Isometry3d X_BG = Eigen::Isometry3d::Identity();
  X_BG.linear() = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  X_BG.translation() = Vector3d(0.02, -0.03, 0.01);
  const BodyDistance primitive({{shape, X_BG}});
  const BodyDistance mesh({{std::make_shared<const robot::TriangleMesh>(robot::triangulate(shape)), X_BG}});
  const BodyDistance cylinder({{robot::Cylinder{0.05, 0.1}, X_BG}});
  for (int i = 0; i < 500; ++i) {
    const Vector3d p = random_point(rng, 0.2);
    EXPECT_NEAR(primitive.query(p, 1).value, mesh.query(p, 1).value, 1e-12);
    for (const BodyDistance* distance : {&primitive, &cylinder}) {
      const Vector3d u = distance->query(p, 1).gradient;
      const double slope = (distance->query(p + 1e-7 * u, 1).value - distance->query(p - 1e-7 * u, 1).value) / 2e-7;
      EXPECT_NEAR(slope, 1.0, 1e-6) << p.transpose();
    }
  }
}

TEST(DistanceGrid, StaysNearTheMeshAndItsGradientIsItsOwnSlope) {
  const auto mesh =
      std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Vector3d(0.06, 0.05, 0.1)}));
  const robot::MeshDistance exact(mesh);
  const DistanceGrid grid(exact, {0.004, 0.03, 1000000}, 2);
  Rng rng = stream(42, "grid");
  double worst_near = 0.0;
  double worst_slope = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p = random_point(rng, 0.1);
    const SignedDistance d = grid.query(p);
    EXPECT_NEAR(d.value, grid.value(p), 1e-15);
    const double error = std::abs(d.value - exact.signed_distance(p));
    if (grid.holds(p)) {
      EXPECT_LE(error, grid.error() + 1e-7);  // nodes are kept in single precision
    }
    if (std::abs(d.value) < 0.02) worst_near = std::max(worst_near, error);
    const Vector3d u = (Vector3d(rng.normal(), rng.normal(), rng.normal())).normalized();
    const double slope = (grid.value(p + 1e-8 * u) - grid.value(p - 1e-8 * u)) / 2e-8;
    worst_slope = std::max(worst_slope, std::abs(slope - d.gradient.dot(u)));
  }
  EXPECT_LT(worst_near, 0.5 * 0.004);
  EXPECT_GT(worst_near, 1e-6);  // it is an approximation: the sides are not the same numbers
  EXPECT_LT(worst_slope, 1e-5);
}

TEST(DistanceGrid, SameNodesForAnyThreadCountAndBoundedSize) {
  const robot::MeshDistance exact(std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Sphere{0.04})));
  const DistanceGrid one(exact, {0.004, 0.03, 5000}, 1);
  const DistanceGrid three(exact, {0.004, 0.03, 5000}, 3);
  EXPECT_GT(one.spacing(), 0.004);  // coarsened to hold at most 5000 nodes
  Rng rng = stream(43, "threads");
  for (int i = 0; i < 200; ++i) {
    const Vector3d p = random_point(rng, 0.07);
    EXPECT_EQ(one.value(p), three.value(p));
  }
}

TEST(GraspTarget, ReadsObjectAndObstaclesInTheObjectFrame) {
  robot::Scene scene = test::with_table(test::scene_of(robot::Box{Vector3d(0.06, 0.05, 0.16)}), -0.08);
  for (robot::SceneBody& b : scene.bodies) b.X_WB = Eigen::Translation3d(1.0, 2.0, 3.0) * b.X_WB;
  const GraspTarget target = make_target(scene, "object", 1);
  EXPECT_NEAR(target.rho, Vector3d(0.03, 0.025, 0.08).norm(), 1e-12);
  EXPECT_NEAR(target.center_of_mass.norm(), 0.0, 1e-12);
  ASSERT_EQ(target.obstacles.size(), 1u);
  const SignedDistance d = target.obstacle_distance(Vector3d(0.1, 0, 0), 1.0);
  EXPECT_NEAR(d.value, 0.08, 1e-12);
  EXPECT_NEAR((d.gradient - Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  Rng rng = stream(44, "seed");
  for (int i = 0; i < 100; ++i) {
    const SurfaceSeed seed = sample_surface(target, rng);
    EXPECT_NEAR(target.distance->signed_distance(seed.p_O), 0.0, 1e-12);
    EXPECT_NEAR(target.distance->signed_distance(seed.p_O + 0.01 * seed.n_O), 0.01, 1e-9);
  }
  // The box's axes, the longest last; seeds along them lie on the face that looks that way.
  EXPECT_NEAR(std::abs(target.axes(2, 2)), 1.0, 1e-6);
  for (int i = 0; i < 100; ++i) {
    const SurfaceSeed seed = sample_axis(target, rng);
    EXPECT_NEAR(seed.n_O.cwiseAbs().maxCoeff(), 1.0, 1e-6);
    EXPECT_NEAR(target.distance->signed_distance(seed.p_O), 0.0, 1e-12);
    EXPECT_NEAR(target.distance->signed_distance(seed.p_O + 0.01 * seed.n_O), 0.01, 1e-6);
  }
  EXPECT_THROW(make_target(scene, "nothing", 1), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
