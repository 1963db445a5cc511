// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "core/rng.hpp"
#include "robot/mesh.hpp"
#include "verify/ball_tree.hpp"

namespace opponens::verify {
namespace {

TEST(Solid, BoxInsideAndDistance) {
  const Solid box(robot::Box{Eigen::Vector3d(2, 4, 6)});
  EXPECT_TRUE(box.closed());
  Rng rng = stream(2, "test/solid");
  int inside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d p(rng.uniform(-2, 2), rng.uniform(-4, 4), rng.uniform(-5, 5));
    const Eigen::Vector3d d = p.cwiseAbs() - Eigen::Vector3d(1, 2, 3);
    const bool in = (d.array() < 0.0).all();
    ASSERT_EQ(box.inside(p), in) << p.transpose();
    const double expected = in ? -d.maxCoeff() : d.cwiseMax(0.0).norm();
    ASSERT_NEAR(box.distance(p), expected, 1e-12);
    EXPECT_NEAR(box.distance(p, 0.1), std::min(0.1, expected), 1e-12);
    inside += in ? 1 : 0;
  }
  EXPECT_GT(inside, 100);
  EXPECT_TRUE(box.inside(Eigen::Vector3d::Zero()));  // rays from the middle meet edges of the triangulation easily
}

TEST(Solid, RoundShapesAreCircumscribed) {
  Rng rng = stream(3, "test/solid/round");
  for (const robot::Shape& shape : {robot::Shape{robot::Sphere{0.05}}, robot::Shape{robot::Cylinder{0.06, 0.4}}}) {
    const bool ball = std::holds_alternative<robot::Sphere>(shape);
    const Solid solid(shape);
    EXPECT_TRUE(solid.closed());
    for (const auto& v : solid.mesh().vertices.colwise()) {
      // No vertex is farther out than the tolerance;
      EXPECT_LE(ball ? v.norm() - 0.05 : v.head<2>().norm() - 0.06, 2e-5);
      EXPECT_LE(std::abs(v.z()), ball ? 0.0501 : 0.2 + 1e-12);
    }
    for (int trial = 0; trial < 2000; ++trial) {
      const double angle = rng.uniform(0, 2 * std::numbers::pi);
      const Eigen::Vector3d direction = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      const Eigen::Vector3d p =
          ball ? Eigen::Vector3d(0.05 * direction)
               : Eigen::Vector3d(0.06 * std::cos(angle), 0.06 * std::sin(angle), rng.uniform(-0.2, 0.2));
      ASSERT_TRUE(solid.inside(p * (1.0 - 1e-9))) << p.transpose();  // and the shape lies within.
      ASSERT_LE(solid.distance(p), 2e-5);
    }
  }
}

TEST(Solid, TheTreeFindsWhatALoopFinds) {
  Rng rng = stream(4, "test/solid/tree");
  robot::TriangleMesh soup;
  soup.vertices = Eigen::Matrix3Xd::NullaryExpr(3, 900, [&] { return rng.uniform(-1, 1); });
  soup.triangles.resize(3, 300);
  for (int i = 0; i < 300; ++i) soup.triangles.col(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  for (int i = 0; i < 300; ++i) {  // small ones, some without area
    for (int k = 1; k < 3; ++k) {
      soup.vertices.col(3 * i + k) =
          soup.vertices.col(3 * i) + (i % 10 == 0 ? k * 0.05 : 1.0) * 0.1 *
                                         (i % 10 == 0 ? Eigen::Vector3d::Ones().eval() : soup.vertices.col(3 * i + k));
    }
  }
  const Solid solid(std::make_shared<const robot::TriangleMesh>(soup));
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3d p(rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5));
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 300; ++i) least = std::min(least, triangle_distance(solid.tree().corners(i), p));
    ASSERT_EQ(solid.distance(p), least);
  }
}

TEST(Solid, ShellIsHollow) {
  robot::TriangleMesh shell = robot::triangulate(robot::Box{Eigen::Vector3d(2, 2, 2)});
  const robot::TriangleMesh cavity = robot::triangulate(robot::Box{Eigen::Vector3d(1, 1, 1)});
  const Eigen::Index vertices = shell.vertices.cols();
  const Eigen::Index triangles = shell.triangles.cols();
  shell.vertices.conservativeResize(3, vertices + cavity.vertices.cols());
  shell.vertices.rightCols(cavity.vertices.cols()) = cavity.vertices;
  shell.triangles.conservativeResize(3, triangles + cavity.triangles.cols());
  shell.triangles.rightCols(cavity.triangles.cols()) = cavity.triangles.array() + static_cast<int>(vertices);
  shell.triangles.rightCols(cavity.triangles.cols())
      .row(1)
      .swap(shell.triangles.rightCols(cavity.triangles.cols()).row(2));
  const Solid solid(std::make_shared<const robot::TriangleMesh>(shell));
  EXPECT_FALSE(solid.inside({0.1, 0.2, 0.3}));
  EXPECT_TRUE(solid.inside({0.7, 0.1, 0.2}));
  EXPECT_FALSE(solid.inside({1.1, 0.1, 0.2}));
}

TEST(Solid, OpenMeshHasNoInside) {
  robot::TriangleMesh open = robot::triangulate(robot::Box{Eigen::Vector3d(2, 2, 2)});
  open.triangles.conservativeResize(3, open.triangles.cols() - 1);
  const Solid solid(std::make_shared<const robot::TriangleMesh>(open));
  EXPECT_FALSE(solid.closed());
  EXPECT_FALSE(solid.inside({0.1, 0.2, 0.3}));
}

TEST(Solid, NormalAngle) {
  const Solid box(robot::Box{Eigen::Vector3d(2, 2, 2)});
  const Eigen::Vector3d on_face(1, 0.2, 0.3);
  EXPECT_NEAR(box.normal_angle(on_face, {1, 0, 0}, 1e-3), 0.0, 1e-7);
  EXPECT_NEAR(box.normal_angle(on_face, {1, 1, 0}, 1e-3), std::numbers::pi / 4, 1e-12);
  EXPECT_NEAR(box.normal_angle(on_face, {-1, 0, 0}, 1e-3), std::numbers::pi, 1e-7);
  EXPECT_NEAR(box.normal_angle({1, 1, 0.3}, {0, 1, 0}, 1e-3), 0.0, 1e-7);  // at an edge either face will do,
  EXPECT_NEAR(box.normal_angle({1, 1, 0.3}, {1, 2, 0}, 1e-3), 0.0, 1e-7);  // and all between them
  EXPECT_NEAR(box.normal_angle({1, 1, 0.3}, {1, 1, std::sqrt(2.0)}, 1e-3), std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(box.normal_angle({3, 0, 0}, {1, 0, 0}, 1e-3), std::numbers::pi);
}

}  // namespace
}  // namespace opponens::verify
