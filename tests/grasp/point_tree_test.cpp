// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/point_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/rng.hpp"
#include "grasp/distance_grid.hpp"
#include "random_contacts.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> scattered(int count, Rng& rng) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(0.05 * std::cbrt(rng.uniform()) * test::random_unit(rng));
    if (i % 7 == 0) points.push_back(points.back());  // repeated ones too
  }
  return points;
}

Eigen::Isometry3d random_pose(Rng& rng) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::AngleAxisd(rng.uniform(0.0, 3.0), test::random_unit(rng)).toRotationMatrix();
  X.translation() = rng.uniform(0.0, 0.15) * test::random_unit(rng);
  return X;
}

TEST(PointTree, FindsTheLeastValueOfAllPointsWithFewOfThem) {
  Rng rng = stream(61, "tree");
  const auto mesh =
      std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Vector3d(0.06, 0.05, 0.1)}));
  const robot::MeshDistance exact(mesh);
  const DistanceGrid grid(exact, {0.004, 0.02, 100000}, 2);
  std::int64_t visited = 0;
  std::int64_t all = 0;
  for (const int count : {1, 3, 4, 5, 100, 3000}) {
    const PointTree tree(scattered(count, rng));
    ASSERT_EQ(tree.points().size(), static_cast<std::size_t>(count + (count + 6) / 7));
    for (int i = 0; i < 20; ++i) {
      const Eigen::Isometry3d X = random_pose(rng);
      const auto moved = [&X](const Vector3d& p) -> Vector3d { return X.linear() * p + X.translation(); };
      double truth = std::numeric_limits<double>::infinity();
      for (const Vector3d& p : tree.points()) truth = std::min(truth, exact.signed_distance(moved(p)));
      double bound = 1.0;
      const auto look = [&](const Vector3d& p, const Vector3d& there) {
        ++visited;
        EXPECT_EQ(moved(p), there);
        return bound = std::min(bound, exact.signed_distance(there));
      };
      all += 2 * static_cast<std::int64_t>(tree.points().size());
      // From exact distances, and from a grid whose error is told.
      const auto distance = [&](const Vector3d& p) { return exact.signed_distance(p); };
      EXPECT_EQ(tree.descend(distance, X, bound, look).bound, truth);
      EXPECT_EQ(tree.descend(distance, X, truth, look).bound, truth);  // nothing is below the bound
      bound = 1.0;
      const auto rough = [&](const Vector3d& p) { return grid.bound(p) - grid.error() - 1e-6; };
      EXPECT_EQ(tree.descend(rough, X, bound, look).bound, truth);
    }
  }
  EXPECT_LT(visited, all / 5);
}

TEST(PointTree, WithoutPointsTheBoundStays) {
  const PointTree tree;
  EXPECT_TRUE(tree.empty());
  const auto never = [](const Vector3d&, const Vector3d&) -> double { throw std::logic_error("there are no points"); };
  EXPECT_EQ(tree.descend([](const Vector3d&) { return 0.0; }, Eigen::Isometry3d::Identity(), 0.7, never).bound, 0.7);
  EXPECT_TRUE(PointTree(std::vector<Vector3d>{}).empty());
}

TEST(DistanceGrid, BoundIsNeverMoreThanTheDistanceAndItsError) {
  Rng rng = stream(62, "grid");
  const auto mesh =
      std::make_shared<const robot::TriangleMesh>(robot::triangulate(robot::Box{Vector3d(0.02, 0.02, 0.02)}));
  const robot::MeshDistance exact(mesh);
  const DistanceGrid grid(exact, {0.003, 0.01, 100000}, 1);
  bool value_was_more = false;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d p = rng.uniform(0.0, 0.1) * test::random_unit(rng);
    const double truth = exact.signed_distance(p);
    EXPECT_LE(grid.bound(p), truth + grid.error() + 1e-7) << p.transpose();
    EXPECT_LE(grid.bound(p), grid.value(p) + 1e-7);  // nodes are in single precision
    value_was_more = value_was_more || grid.value(p) > truth + grid.error() + 1e-7;
  }
  EXPECT_TRUE(value_was_more);  // outside the grid the value is an upper bound: the two differ
}

}  // namespace
}  // namespace opponens::grasp
