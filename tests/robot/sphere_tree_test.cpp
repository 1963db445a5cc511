// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/sphere_tree.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "made_robots.hpp"
#include "robot/bounding_volume_tree.hpp"
#include "robot_test.hpp"
#include "solid_points.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Whether a way from the root to a leaf leads through balls that all contain p. It must for every point of the solid:
/// p is in a part of some child whenever it is in the node's.
bool covered(const SphereTree& tree, int index, const Vector3d& p) {
  const SphereTree::Node& node = tree.nodes[static_cast<std::size_t>(index)];
  if ((p - node.center).norm() > node.radius * (1.0 + 1e-12)) return false;
  if (node.children == 0) return true;
  for (int child = 0; child < node.children; ++child) {
    if (covered(tree, node.first_child + child, p)) return true;
  }
  return false;
}

int uncovered(const SphereTree& tree, const std::vector<Vector3d>& points) {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [&](const Vector3d& p) { return !covered(tree, 0, p); }));
}

TEST(SphereTree, EveryPointIsInBallsFromTheRootToALeaf) {
  Rng rng(1);
  for (const Case& c : cases()) {
    const SphereTree tree = sphere_tree(mesh_of(c.mesh));
    ASSERT_GT(tree.nodes.size(), 1U) << c.name;
    EXPECT_EQ(uncovered(tree, surface_points(c.mesh, 4000, rng)), 0) << c.name;
    if (!c.solid) continue;
    const std::vector<Vector3d> inside = inner_points(c.mesh, 4000, rng);
    EXPECT_GT(inside.size(), 100U) << c.name;
    EXPECT_EQ(uncovered(tree, inside), 0) << c.name;
  }
}

TEST(SphereTree, PrimitivesAreCovered) {
  Rng rng(2);
  const std::vector<Shape> shapes{Box{{0.3, 0.02, 0.1}}, Sphere{0.07}, Cylinder{0.02, 0.6}, Cylinder{0.3, 0.01},
                                  Box{{20, 30, 0.1}}};
  for (const Shape& shape : shapes) {
    const TriangleMesh mesh = triangulate(shape, 90);  // inscribed in the shape
    const SphereTree tree = sphere_tree(shape);
    EXPECT_EQ(uncovered(tree, surface_points(mesh, 4000, rng)), 0) << shape.index();
    EXPECT_EQ(uncovered(tree, inner_points(mesh, 2000, rng)), 0) << shape.index();
    for (const Vector3d& p : surface_samples({shape}, 0.05 * (mesh.vertices.rowwise().maxCoeff()).maxCoeff())) {
      EXPECT_TRUE(covered(tree, 0, p)) << shape.index() << " " << p.transpose();
    }
  }
}

TEST(SphereTree, SmallerBallsOrFewerLeavesWouldBeNoticed) {
  // The companion of the tests above.
  Rng rng(3);
  for (const Case& c : cases()) {
    const SphereTree tree = sphere_tree(mesh_of(c.mesh));
    const std::vector<Vector3d> points = surface_points(c.mesh, 4000, rng);
    SphereTree smaller = tree;
    for (SphereTree::Node& node : smaller.nodes) node.radius *= 0.9;
    EXPECT_GT(uncovered(smaller, points), 0) << c.name;
    SphereTree fewer = tree;
    fewer.nodes.back().radius = 0.0;
    EXPECT_GT(uncovered(fewer, points), 0) << c.name;
  }
}

/// The farthest that a leaf's ball is seen to stick out of the solid, m and in radii.
struct Overhang {
  double length = 0.0;
  double share = 0.0;
};
Overhang overhang(const SphereTree& tree, const TriangleMesh& mesh, bool solid, Rng& rng) {
  const BoundingVolumeTree surface(mesh);
  Overhang farthest;
  const std::size_t stride = 1 + tree.nodes.size() / 200;
  for (std::size_t k = 0; k < tree.nodes.size(); k += stride) {
    const SphereTree::Node& node = tree.nodes[k];
    if (node.children > 0) continue;
    for (int i = 0; i < 30; ++i) {
      const Vector3d p = node.center + node.radius * random_direction(rng);
      if (solid && winding_number(mesh, p) > 0.5) continue;
      const double out = std::sqrt(surface.nearest(p).squared_distance);
      farthest.length = std::max(farthest.length, out);
      farthest.share = std::max(farthest.share, out / node.radius);
    }
  }
  return farthest;
}

TEST(SphereTree, BallsStickOutLittle) {
  // The smallest ball around points has some of them in every half of its surface, hence one within sqrt(2) radii of
  // each place on it. Ours are nearly the smallest; and with leaves to spare none is larger than asked for.
  Rng rng(4);
  const SphereTreeSettings fine{20000, 0.015};
  constexpr double kShare = 1.5;
  for (const Case& c : cases()) {
    if (c.name == "sliver") continue;
    const Shape shape = mesh_of(c.mesh);
    const Overhang ours = overhang(sphere_tree(shape, fine), c.mesh, c.solid, rng);
    EXPECT_LT(ours.share, kShare) << c.name;
    EXPECT_LT(ours.length, kShare * fine.radius) << c.name;
    SphereTree larger = sphere_tree(shape);
    for (SphereTree::Node& node : larger.nodes) node.radius *= 2.0;
    EXPECT_GT(overhang(larger, c.mesh, c.solid, rng).share, 0.5) << c.name;
    if (c.name == "ball") continue;  // its root alone is as good
    const Overhang root_only = overhang(sphere_tree(shape, {1, 1e-3}), c.mesh, c.solid, rng);
    EXPECT_GT(root_only.length, kShare * fine.radius) << c.name;
  }
}

TEST(SphereTree, SettingsAreKept) {
  const Shape shape = mesh_of(torus(0.1, 0.03));
  for (const int leaves : {1, 2, 5, 48, 200}) {
    const SphereTree tree = sphere_tree(shape, {leaves, 1e-4});
    int found = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      const SphereTree::Node& node = tree.nodes[i];
      found += node.children == 0 ? 1 : 0;
      if (node.children > 0) {
        EXPECT_GT(node.first_child, static_cast<int>(i));
        EXPECT_LE(node.first_child + node.children, static_cast<int>(tree.nodes.size()));
      }
    }
    EXPECT_EQ(found, leaves);
  }
  EXPECT_THROW(sphere_tree(shape, {0, 0.01}), std::invalid_argument);
  EXPECT_THROW(sphere_tree(shape, {10, 0.0}), std::invalid_argument);
  EXPECT_THROW(sphere_tree(mesh_of(TriangleMesh{})), std::invalid_argument);
}

TEST(SphereTree, DegenerateMeshesEnd) {
  TriangleMesh mesh;
  mesh.triangles.resize(3, 1);
  mesh.triangles << 0, 1, 2;
  for (const double size : {0.0, 1e-300, 1.0, 1e50, 1e120, 1e200}) {
    mesh.vertices = size * Eigen::Matrix3d::Identity();
    const SphereTree tree = sphere_tree(mesh_of(mesh));
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(covered(tree, 0, mesh.vertices.col(k)) || size > 1e100) << size;
  }
}

TEST(SphereTree, RealMeshesAreCovered) {
  if (!fs::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  Rng rng(5);
  std::size_t inside = 0;
  const auto meshes = real_meshes();
  ASSERT_GT(meshes.size(), 15U);
  for (const auto& mesh : meshes) {
    const SphereTree tree = sphere_tree(mesh);
    EXPECT_EQ(uncovered(tree, surface_points(*mesh, 3000, rng)), 0) << mesh->source;
    if (!is_closed(*mesh)) continue;
    const std::vector<Vector3d> points = inner_points(*mesh, 100, rng);
    EXPECT_EQ(uncovered(tree, points), 0) << mesh->source;
    inside += points.size();
  }
  EXPECT_GT(inside, 200U);
}

}  // namespace
}  // namespace opponens::robot
