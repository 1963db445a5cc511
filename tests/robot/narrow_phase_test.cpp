// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/narrow_phase.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/convex_distance.hpp"
#include "robot/mesh.hpp"
#include "robot_test.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d random_pose(double spread, Rng& rng) {
  const Eigen::Quaterniond q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  Isometry3d X = at(spread * rng.normal(), spread * rng.normal(), spread * rng.normal());
  X.linear() = q.normalized().toRotationMatrix();
  return X;
}

Shape random_primitive(int kind, Rng& rng) {
  if (kind == 0) return Box{{rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3)}};
  if (kind == 1) return Sphere{rng.uniform(0.01, 0.15)};
  return Cylinder{rng.uniform(0.01, 0.1), rng.uniform(0.02, 0.4)};
}

Shape mesh_of(const Shape& shape, int segments = 48) {
  return std::make_shared<TriangleMesh>(triangulate(shape, segments));
}

bool meet(const Shape& a, const Isometry3d& X_WA, const Shape& b, const Isometry3d& X_WB) {
  return intersect(CollisionShape(a), X_WA, CollisionShape(b), X_WB);
}

double gap(const Shape& a, const Isometry3d& X_WA, const Shape& b, const Isometry3d& X_WB) {
  return separation(CollisionShape(a), X_WA, CollisionShape(b), X_WB);
}

struct Case {
  Shape a;
  Shape b;
  double touching;  ///< distance of the centres along x at which the two touch
};

std::vector<Case> pairs_by_hand() {
  const Shape box = Box{{0.2, 0.4, 0.6}};
  const Shape sphere = Sphere{0.3};
  const Shape cylinder = Cylinder{0.15, 0.5};
  return {{box, box, 0.2},
          {box, sphere, 0.4},
          {box, cylinder, 0.25},
          {sphere, sphere, 0.6},
          {sphere, cylinder, 0.45},
          {cylinder, cylinder, 0.3},
          {mesh_of(box), box, 0.2},
          {mesh_of(box), sphere, 0.4},
          {mesh_of(box), cylinder, 0.25},
          {mesh_of(box), mesh_of(box), 0.2}};
}

TEST(NarrowPhase, EveryPairOfShapesByHand) {
  for (const Case& c : pairs_by_hand()) {
    for (const double shift : {-0.02, -0.001, 0.001, 0.02, 1.0}) {
      const double distance = c.touching + shift;
      EXPECT_EQ(meet(c.a, at(0, 0, 0), c.b, at(distance, 0, 0)), shift < 0.0)
          << c.a.index() << c.b.index() << " " << shift;
      EXPECT_EQ(meet(c.b, at(distance, 0, 0), c.a, at(0, 0, 0)), shift < 0.0)
          << c.b.index() << c.a.index() << " " << shift;
      EXPECT_NEAR(gap(c.a, at(0, 0, 0), c.b, at(distance, 0, 0)), std::max(0.0, shift), 1e-6)
          << c.a.index() << c.b.index() << " " << shift;
    }
  }
}

TEST(NarrowPhase, AShapeWithinAnotherCollides) {
  // Surfaces are apart in all of these; FCL alone calls the ones inside a mesh free.
  const std::vector<Shape> small{Box{{0.02, 0.02, 0.02}}, Sphere{0.01}, Cylinder{0.01, 0.02},
                                 mesh_of(Box{{0.02, 0.02, 0.02}})};
  const std::vector<Shape> large{Box{{1, 1, 1}}, Sphere{0.5}, Cylinder{0.5, 1}, mesh_of(Sphere{0.5})};
  for (const Shape& s : small) {
    for (const Shape& l : large) {
      EXPECT_TRUE(meet(s, at(0.1, 0.1, 0.1), l, at(0, 0, 0))) << s.index() << l.index();
      EXPECT_TRUE(meet(l, at(0, 0, 0), s, at(0.1, 0.1, 0.1))) << s.index() << l.index();
      EXPECT_EQ(gap(l, at(0, 0, 0), s, at(0.1, 0.1, 0.1)), 0.0);
    }
  }
}

TEST(NarrowPhase, FclAloneMissesContainment) {
  // The companion of the test above: without containment the verdict would be wrong.
  const TriangleMesh mesh = triangulate(Sphere{0.5}, 24);
  fcl::BVHModel<fcl::OBBRSSd> model;
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) vertices.emplace_back(mesh.vertices.col(i));
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    triangles.emplace_back(mesh.triangles(0, i), mesh.triangles(1, i), mesh.triangles(2, i));
  }
  model.beginModel();
  model.addSubModel(vertices, triangles);
  model.endModel();
  const fcl::Boxd box(0.02, 0.02, 0.02);
  fcl::CollisionResultd result;
  fcl::collide(&model, at(0, 0, 0), &box, at(0.1, 0.1, 0.1), fcl::CollisionRequestd(), result);
  EXPECT_FALSE(result.isCollision());
}

TEST(NarrowPhase, HollowsSheetsAndSecondComponents) {
  const auto inside_out = [](TriangleMesh mesh) {
    mesh.triangles.row(1).swap(mesh.triangles.row(2));
    return std::make_shared<const TriangleMesh>(std::move(mesh));
  };
  const auto cube = [](double edge) { return triangulate(Box{{edge, edge, edge}}); };
  const Shape hollow = std::make_shared<TriangleMesh>(merge({{mesh_of(Box{{1, 1, 1}})}, {inside_out(cube(0.5))}}));
  const Shape probe = Sphere{0.01};
  EXPECT_FALSE(meet(hollow, at(0, 0, 0), probe, at(0, 0, 0)));
  EXPECT_TRUE(meet(hollow, at(0, 0, 0), probe, at(0.4, 0, 0)));
  EXPECT_FALSE(meet(hollow, at(0, 0, 0), probe, at(0.6, 0, 0)));
  // A solid whose faces all look inwards is a solid.
  EXPECT_TRUE(meet(Shape(inside_out(cube(1))), at(0, 0, 0), probe, at(0.1, 0, 0)));
  EXPECT_FALSE(meet(Shape(inside_out(cube(1))), at(0, 0, 0), probe, at(0.6, 0, 0)));
  // Overlapping components: near the inner surface of one, but within the other.
  Geometry moved{mesh_of(Box{{1, 1, 1}})};
  moved.X_BG = at(0.8, 0, 0);
  const Shape overlapping = std::make_shared<TriangleMesh>(merge({{mesh_of(Box{{1, 1, 1}})}, moved}));
  EXPECT_TRUE(meet(overlapping, at(0, 0, 0), probe, at(0.33, 0, 0)));
  EXPECT_TRUE(meet(overlapping, at(0, 0, 0), probe, at(0.27, 0, 0)));
  // Only the second component of the mesh lies within the box's mesh.
  Geometry far{mesh_of(Box{{0.1, 0.1, 0.1}})};
  far.X_BG = at(5, 0, 0);
  const Shape two = std::make_shared<TriangleMesh>(merge({{mesh_of(Box{{0.1, 0.1, 0.1}})}, far}));
  EXPECT_TRUE(meet(two, at(-5, 0, 0), mesh_of(Box{{1, 1, 1}}), at(0, 0, 0)));
  // An open mesh has no inside.
  TriangleMesh open = cube(1);
  open.triangles.conservativeResize(3, 10);
  const Shape lidless = std::make_shared<TriangleMesh>(open);
  EXPECT_TRUE(CollisionShape(lidless).open_surface());
  EXPECT_FALSE(CollisionShape(hollow).open_surface());
  EXPECT_FALSE(meet(lidless, at(0, 0, 0), probe, at(0, 0, 0)));
  EXPECT_TRUE(meet(lidless, at(0, 0, 0), probe, at(0, 0, -0.5)));
}

TEST(NarrowPhase, DistanceBoundsAreProvenAndTight) {
  Rng rng(21);
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      int apart = 0;
      for (int i = 0; i < sample_count(2000); ++i) {
        const Shape A = random_primitive(a, rng);
        const Shape B = random_primitive(b, rng);
        const Isometry3d X_WA = random_pose(0.12, rng);
        const Isometry3d X_WB = random_pose(0.12, rng);
        const ConvexDistance d = convex_distance(A, X_WA, B, X_WB);
        const ConvexDistance other = convex_distance(B, X_WB, A, X_WA);
        EXPECT_LE(d.upper - d.lower, 1e-7) << a << b << " " << i;
        EXPECT_NEAR(d.lower, other.lower, 2e-7);
        // FCL's verdict and the bounds tell the same story.
        EXPECT_EQ(meet(A, X_WA, B, X_WB), d.lower == 0.0) << a << b << " " << i << " " << d.upper;
        apart += d.lower > 0.0 ? 1 : 0;
      }
      EXPECT_GT(apart, sample_count(500));
      EXPECT_LT(apart, sample_count(1990));
    }
  }
  EXPECT_THROW(convex_distance(mesh_of(Sphere{1}), at(0, 0, 0), Sphere{1}, at(0, 0, 0)), std::invalid_argument);
}

Shape scaled_primitive(const Shape& shape, double factor) {
  if (const auto* box = std::get_if<Box>(&shape)) return Box{factor * box->size};
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return Sphere{factor * sphere->radius};
  const auto& cylinder = std::get<Cylinder>(shape);
  return Cylinder{factor * cylinder.radius, factor * cylinder.length};
}

TEST(NarrowPhase, MeshesAgreeWithThePrimitivesTheyAreMadeOf) {
  // An inscribed mesh of 48 segments lies between the primitive and the same shrunk by cos(pi / 48)^2 = 0.9957; its
  // surface is at most 0.0043 * 0.15 m = 0.65 mm away. Between the two, either verdict is right.
  Rng rng(22);
  const double shrink = 0.9956;
  const double band = 2 * 0.65e-3;
  int apart = 0;
  int deep = 0;
  for (int i = 0; i < 450; ++i) {
    const Shape A = random_primitive(i % 3, rng);
    const Shape B = random_primitive(i / 3 % 3, rng);
    const Isometry3d X_WA = random_pose(0.12, rng);
    const Isometry3d X_WB = random_pose(0.12, rng);
    const std::vector<CollisionShape> as{CollisionShape(A), CollisionShape(mesh_of(A))};
    const std::vector<CollisionShape> bs{CollisionShape(B), CollisionShape(mesh_of(B))};
    const double distance = separation(as[0], X_WA, bs[0], X_WB);
    const bool must_meet = meet(scaled_primitive(A, shrink), X_WA, scaled_primitive(B, shrink), X_WB);
    for (const CollisionShape& a : as) {
      for (const CollisionShape& b : bs) {
        if (distance > 0.0) {
          EXPECT_NEAR(separation(a, X_WA, b, X_WB), distance, band) << i;
        } else if (must_meet) {
          EXPECT_TRUE(intersect(a, X_WA, b, X_WB)) << i;
        }
      }
    }
    apart += distance > 0.0 ? 1 : 0;
    deep += must_meet ? 1 : 0;
  }
  EXPECT_GT(apart, 200);
  EXPECT_GT(deep, 50);
}

TEST(NarrowPhase, BoundingVolumesBoundAndCull) {
  Rng rng(23);
  int culled = 0;
  for (int i = 0; i < sample_count(4000); ++i) {
    const Box a{{rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3)}};
    const Box b{{rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3), rng.uniform(0.02, 0.3)}};
    const Isometry3d X_WA = random_pose(0.15, rng);
    const Isometry3d X_WB = random_pose(0.15, rng);
    const OrientedBox box_a{X_WA.translation(), X_WA.linear(), 0.5 * a.size};
    const OrientedBox box_b{X_WB.translation(), X_WB.linear(), 0.5 * b.size};
    const double distance = convex_distance(a, X_WA, b, X_WB).upper;
    EXPECT_EQ(boxes_apart(box_a, box_b, 0.0), distance > 1e-7) << distance;
    if (boxes_apart(box_a, box_b, 0.01)) {
      EXPECT_GT(distance, 0.01);
      ++culled;
    }
    EXPECT_NEAR(point_box_distance(X_WB.translation(), box_a), convex_distance(a, X_WA, Sphere{1e-9}, X_WB).upper,
                1e-6);
  }
  EXPECT_GT(culled, sample_count(1000));
}

TEST(NarrowPhase, TheVerdictMovesWithThePair) {
  Rng rng(24);
  for (int i = 0; i < 300; ++i) {
    const int b = static_cast<int>(rng.index(3));
    const CollisionShape A(i % 2 == 0 ? mesh_of(random_primitive(static_cast<int>(rng.index(3)), rng), 16)
                                      : random_primitive(static_cast<int>(rng.index(3)), rng));
    const CollisionShape B(random_primitive(b, rng));
    const Isometry3d X_WA = random_pose(0.1, rng);
    const Isometry3d X_WB = random_pose(0.1, rng);
    const Isometry3d X_VW = random_pose(1.0, rng);
    const double here = separation(A, X_WA, B, X_WB);
    if (here > 0.0 && here < 1e-5) continue;  // rounding of the move may decide
    EXPECT_NEAR(separation(A, X_VW * X_WA, B, X_VW * X_WB), here, 1e-6) << i;
    EXPECT_NEAR(separation(B, X_WB, A, X_WA), here, 1e-6) << i;
  }
}

TEST(NarrowPhase, BadShapesAreRefused) {
  for (const Shape& shape : std::vector<Shape>{Box{{1, 0, 1}}, Sphere{-1}, Cylinder{1, std::nan("")},
                                               std::make_shared<const TriangleMesh>()}) {
    EXPECT_THROW(CollisionShape{shape}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace opponens::robot
