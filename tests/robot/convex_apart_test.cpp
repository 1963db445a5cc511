// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/convex_apart.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

#include "core/rng.hpp"
#include "made_robots.hpp"
#include "robot/convex_distance.hpp"
#include "robot/convex_hull.hpp"
#include "robot_test.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// How much farther the mesh reaches along unit n than the hull's vertices, m.
double missing(const TriangleMesh& mesh, const HullVertices& hull, const Vector3d& n) {
  double far = -1e300;
  for (int i = 0; i < hull.all.count; ++i) far = std::max(far, n.dot(hull.all.point(i)));
  return (n.transpose() * mesh.vertices).maxCoeff() - far;
}

std::vector<TriangleMesh> meshes() {
  Rng rng(1);
  TriangleMesh cloud;  // vertices of no order, most of them inside
  cloud.vertices.resize(3, 3000);
  for (Eigen::Index i = 0; i < cloud.vertices.cols(); ++i) {
    cloud.vertices.col(i) << rng.normal(), rng.normal(), 3.0 + rng.normal();
  }
  cloud.triangles.resize(3, cloud.vertices.cols() / 3);
  for (int i = 0; i < static_cast<int>(cloud.triangles.cols()); ++i)
    cloud.triangles.col(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  TriangleMesh flat = cloud;
  flat.vertices.row(2).setConstant(0.5);
  TriangleMesh line = flat;
  line.vertices.row(0) = 0.3 * line.vertices.row(1);
  TriangleMesh one = triangulate(Box{{1, 1, 1}});
  one.vertices = one.vertices.leftCols(3).eval();
  one.triangles = cloud.triangles.leftCols(1).eval();
  TriangleMesh tiny = torus(1e-4, 2e-5, 16);
  TriangleMesh far = torus(0.1, 0.02);
  far.vertices.colwise() += Vector3d(1000, -500, 2);
  return {cloud,
          flat,
          line,
          one,
          tiny,
          far,
          mug(),
          torus(0.1, 0.02),
          triangulate(Sphere{0.2}, 48),
          triangulate(Box{{0.1, 0.2, 0.3}})};
}

TEST(HullVertices, ReachAsFarAsTheMeshInEveryDirection) {
  Rng rng(2);
  const std::vector<TriangleMesh> all = meshes();
  for (std::size_t m = 0; m < all.size(); ++m) {
    const HullVertices hull = hull_vertices(all[m]);
    EXPECT_EQ(hull.all.count % 8, 0);
    EXPECT_EQ(hull.all.xyz.size(), 3U * static_cast<std::size_t>(hull.all.count));
    for (int i = 0; i < sample_count(2000); ++i) {
      const Vector3d n = random_direction(rng);
      const double lack = missing(all[m], hull, n);
      EXPECT_LE(lack, hull.rounding) << m << " " << n.transpose();
      EXPECT_GE(lack, -hull.rounding) << m << " " << n.transpose();
    }
  }
}

TEST(HullVertices, AVertexLessWouldBeNoticed) {
  const TriangleMesh box = triangulate(Box{{0.1, 0.2, 0.3}});
  HullVertices hull = hull_vertices(box);
  ASSERT_EQ(hull.all.count, 8);
  EXPECT_LE(missing(box, hull, hull.all.point(0).normalized()), hull.rounding);
  for (const std::size_t i : {0, 8, 16}) hull.all.xyz[i] = hull.all.xyz[i + 1];
  Rng rng(3);
  int noticed = 0;
  for (int i = 0; i < 2000; ++i) noticed += missing(box, hull, random_direction(rng)) > hull.rounding ? 1 : 0;
  EXPECT_GT(noticed, 50);
}

TEST(HullVertices, InnerVerticesAreLeftOut) {
  EXPECT_LT(hull_vertices(meshes()[0]).all.count, 200);
  // Of a torus, the inner half of the tube.
  const TriangleMesh ring = torus(0.1, 0.02);
  EXPECT_LE(hull_vertices(ring).all.count, static_cast<int>(ring.vertices.cols()) * 6 / 10);
}

TEST(HullVertices, OfAPlaneItsOutline) {
  // A disc of points, tilted: about the square root of them are on its rim.
  Rng rng(7);
  const Isometry3d X = random_pose(0.3, rng);
  Eigen::Matrix3Xd disc(3, 2000);
  for (auto p : disc.colwise()) {
    const double angle = rng.uniform(0, 6.283);
    p = X * (0.1 * std::sqrt(rng.uniform()) * Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
  const std::vector<Eigen::Index> outline = hull_indices(disc);
  EXPECT_LT(outline.size(), 100U);
  EXPECT_TRUE(std::is_sorted(outline.begin(), outline.end()));
  for (int i = 0; i < 1000; ++i) {
    const Vector3d n = random_direction(rng);
    EXPECT_NEAR((n.transpose() * disc(Eigen::all, outline)).maxCoeff(), (n.transpose() * disc).maxCoeff(), 1e-12);
  }
}

TEST(HullVertices, TheFewAreSomeOfThem) {
  const HullVertices ball = hull_vertices(triangulate(Sphere{0.2}, 48));
  ASSERT_GT(ball.few.count, 0);
  EXPECT_LT(ball.few.count, ball.all.count / 4);
  for (int i = 0; i < ball.few.count; ++i) {
    bool known = false;
    for (int k = 0; k < ball.all.count; ++k) known |= ball.few.point(i) == ball.all.point(k);
    EXPECT_TRUE(known) << i;
  }
  EXPECT_EQ(hull_vertices(triangulate(Box{{1, 1, 1}})).few.count, 0);
  EXPECT_THROW(hull_vertices(Eigen::Matrix3Xd(3, 0)), std::invalid_argument);
}

/// Two convex shapes near each other.
struct Pair {
  Shape a, b;
  Isometry3d X_WA, X_WB;
};

Shape random_convex(Rng& rng) {
  const double size = rng.uniform(0.02, 0.3);
  switch (rng.index(3)) {
    case 0:
      return Box{{size, size * rng.uniform(0.05, 1), size * rng.uniform(0.05, 1)}};
    case 1:
      return Sphere{0.5 * size};
    default:
      return Cylinder{size * rng.uniform(0.05, 0.6), size};
  }
}

/// Their centres are at most 1.2 times the sum of their bounding spheres' radii apart.
Pair random_pair(Rng& rng) {
  Pair pair{random_convex(rng), random_convex(rng), random_pose(1.0, rng), random_pose(1.0, rng)};
  const double reach = CollisionShape(pair.a).radius() + CollisionShape(pair.b).radius();
  pair.X_WB.translation() = pair.X_WA.translation() + rng.uniform(0.0, 1.2) * reach * random_direction(rng);
  return pair;
}

/// A primitive's mesh, whose vertices lie on it, in place of a box or cylinder: its hull is within the primitive.
Shape meshed(const Shape& shape) {
  if (std::holds_alternative<Sphere>(shape)) return shape;
  return mesh_of(triangulate(shape, 32));
}

constexpr double kMargin = 2e-6;

TEST(ConvexRelation, OverlappingStaysSoWhereverOneIsMovedByTheDepth) {
  constexpr double kDepth = 1e-3;
  Rng rng(5);
  int overlapping = 0;
  for (int i = 0; i < sample_count(5000); ++i) {
    const Pair pair = random_pair(rng);
    const CollisionShape a(pair.a);
    const CollisionShape b(pair.b);
    if (convex_relation(a, pair.X_WA, b, pair.X_WB, kMargin, kDepth) != Convex::overlapping) continue;
    ++overlapping;
    for (int k = 0; k < 5; ++k) {
      const Eigen::Vector3d direction(rng.normal(), rng.normal(), rng.normal());
      Eigen::Isometry3d X_WB = pair.X_WB;
      X_WB.pretranslate(0.99 * kDepth * direction.normalized());
      EXPECT_TRUE(intersect(a, pair.X_WA, b, X_WB)) << i;
    }
  }
  EXPECT_GT(overlapping, sample_count(300));
}

TEST(ConvexApart, NeverWhereTheTwoMeetAndNearlyAlwaysBeyondAMillimetre) {
  // Null hypothesis: it misses one in a thousand of the pairs that are a millimetre apart. The bound is the binomial
  // distribution's upper quantile, false alarms 1e-4. The known-wrong rule, bounding spheres, must be rejected.
  Rng rng(4);
  int asked = 0;
  int missed = 0;
  int missed_by_spheres = 0;
  for (int i = 0; i < sample_count(20000); ++i) {
    const Pair pair = random_pair(rng);
    const CollisionShape a(pair.a);
    const CollisionShape b(pair.b);
    const ConvexDistance distance = convex_distance(pair.a, pair.X_WA, pair.b, pair.X_WB);
    const bool apart = convex_apart(a, pair.X_WA, b, pair.X_WB, kMargin);
    const bool back = convex_apart(b, pair.X_WB, a, pair.X_WA, kMargin);
    if (distance.upper < 0.5 * kMargin) {
      EXPECT_FALSE(apart || back) << i;
    }
    if (apart) {
      EXPECT_FALSE(intersect(a, pair.X_WA, b, pair.X_WB)) << i;
    }
    if (distance.lower < 1e-3) continue;
    ++asked;
    missed += apart && back ? 0 : 1;
    const double centers = (pair.X_WA.translation() - pair.X_WB.translation()).norm();
    missed_by_spheres += centers > a.radius() + b.radius() ? 0 : 1;
  }
  ASSERT_GT(asked, sample_count(5000));
  const boost::math::binomial_distribution<> null(asked, 1e-3);
  const double bound = boost::math::quantile(boost::math::complement(null, 1e-4));
  EXPECT_LE(missed, bound);
  EXPECT_GT(missed_by_spheres, bound);
}

TEST(ConvexApart, MeshesLikewise) {
  Rng rng(6);
  int asked = 0;
  int found = 0;
  for (int i = 0; i < sample_count(2000); ++i) {
    const Pair pair = random_pair(rng);
    const CollisionShape a(meshed(pair.a));
    const CollisionShape b(meshed(pair.b));
    const bool apart = convex_apart(a, pair.X_WA, b, pair.X_WB, kMargin);
    if (apart) {
      EXPECT_FALSE(intersect(a, pair.X_WA, b, pair.X_WB)) << i;
    }
    if (convex_distance(pair.a, pair.X_WA, pair.b, pair.X_WB).lower < 1e-3) continue;
    ++asked;  // the meshes lie within the primitives
    found += apart ? 1 : 0;
  }
  ASSERT_GT(asked, sample_count(500));
  const boost::math::binomial_distribution<> null(asked, 1e-3);  // as above
  EXPECT_LE(asked - found, boost::math::quantile(boost::math::complement(null, 1e-4)));
}

TEST(ConvexApart, PushedTogetherUntilTheyTouch) {
  // The verdict changes within a few micrometres of contact, and only on the far side of it.
  Rng rng(5);
  for (int i = 0; i < sample_count(1000); ++i) {
    Pair pair = random_pair(rng);
    const CollisionShape a(pair.a);
    const CollisionShape b(pair.b);
    const Vector3d direction = random_direction(rng);
    double near = 0.0;
    double far = 2.0 * (a.radius() + b.radius());
    while (far - near > 1e-8) {
      const double middle = 0.5 * (near + far);
      pair.X_WB.translation() = pair.X_WA.translation() + middle * direction;
      (intersect(a, pair.X_WA, b, pair.X_WB) ? near : far) = middle;
    }
    pair.X_WB.translation() = pair.X_WA.translation() + near * direction;
    EXPECT_FALSE(convex_apart(a, pair.X_WA, b, pair.X_WB, kMargin)) << i;
  }
}

TEST(ConvexApart, NonConvexMeshesAndNestedOnesAreUnknown) {
  const CollisionShape ring(mesh_of(torus(0.1, 0.02)));
  const CollisionShape ball(Shape(Sphere{0.01}));
  const Isometry3d still = at(0, 0, 0);
  EXPECT_FALSE(convex_apart(ring, still, ball, still, kMargin));  // in the hole: apart, but not the hulls
  EXPECT_TRUE(convex_apart(ring, still, ball, at(0, 0, 0.04), kMargin));
  EXPECT_FALSE(convex_apart(ring, still, ring, still, kMargin));
  for (const Shape& shape : {Shape(Box{{1, 1, 1}}), Shape(Sphere{1}), Shape(Cylinder{1, 1})}) {
    EXPECT_FALSE(convex_apart(CollisionShape(shape), still, ball, still, kMargin));
    EXPECT_FALSE(convex_apart(ball, at(0, 0, 1e-9), CollisionShape(shape), still, kMargin));
    EXPECT_TRUE(convex_apart(ball, at(1e4, 0, 0), CollisionShape(shape), still, kMargin));
  }
}

}  // namespace
}  // namespace opponens::robot
