// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/sphere_tree.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "made_robots.hpp"
#include "robot/bounding_volume_tree.hpp"
#include "robot/load_robot.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// How often the surface winds around a point (sum of solid angles, Van Oosterom and Strackee 1983): the oracle of what
/// is inside, independent of signed distances. Above 0.5: inside. Components count up, cavities down.
double winding_number(const TriangleMesh& mesh, const Vector3d& p) {
  double sum = 0.0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Vector3d a = mesh.vertices.col(mesh.triangles(0, f)) - p;
    const Vector3d b = mesh.vertices.col(mesh.triangles(1, f)) - p;
    const Vector3d c = mesh.vertices.col(mesh.triangles(2, f)) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

Vector3d surface_point(const TriangleMesh& mesh, Rng& rng) {
  const auto f = static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(mesh.triangles.cols())));
  double u = rng.uniform();
  double v = rng.uniform();
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const Vector3d a = mesh.vertices.col(mesh.triangles(0, f));
  return a + u * (mesh.vertices.col(mesh.triangles(1, f)) - a) + v * (mesh.vertices.col(mesh.triangles(2, f)) - a);
}

std::vector<Vector3d> surface_points(const TriangleMesh& mesh, int count, Rng& rng) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(surface_point(mesh, rng));
  for (Eigen::Index i = 0; i < mesh.vertices.cols() && i < count; ++i) points.emplace_back(mesh.vertices.col(i));
  return points;
}

/// Points of a mesh's box that its surface winds around.
std::vector<Vector3d> inner_points(const TriangleMesh& mesh, int tries, Rng& rng) {
  const Vector3d lower = mesh.vertices.rowwise().minCoeff();
  const Vector3d size = mesh.vertices.rowwise().maxCoeff() - lower;
  std::vector<Vector3d> points;
  for (int i = 0; i < tries; ++i) {
    const Vector3d p = lower + size.cwiseProduct(Vector3d(rng.uniform(), rng.uniform(), rng.uniform()));
    if (winding_number(mesh, p) > 0.5) points.push_back(p);
  }
  return points;
}

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

struct Case {
  std::string name;
  TriangleMesh mesh;
  bool solid = true;
};

TriangleMesh flipped(TriangleMesh mesh) {
  mesh.triangles.row(0).swap(mesh.triangles.row(1));
  return mesh;
}

TriangleMesh open_box() {
  TriangleMesh mesh = triangulate(Box{{0.1, 0.2, 0.05}});
  mesh.triangles.conservativeResize(3, 10);
  return mesh;
}

TriangleMesh sheet(double length, double width) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, length, length, 0, 0, 0, width, width, 0.1, 0.1, 0.1, 0.1;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  return mesh;
}

TriangleMesh with_cavity() {
  const Geometry outside{mesh_of(triangulate(Box{{0.2, 0.2, 0.2}}))};
  const Geometry hollow{mesh_of(flipped(triangulate(Box{{0.12, 0.1, 0.14}})))};
  return merge({outside, hollow});
}

TriangleMesh two_parts() {
  Geometry left{mesh_of(triangulate(Cylinder{0.03, 0.2}, 24))};
  Geometry right{mesh_of(triangulate(Sphere{0.05}, 24))};
  right.X_BG.translation() << 0.02, 0.3, 0.0;
  Geometry overlapping{mesh_of(triangulate(Box{{0.08, 0.02, 0.03}}))};
  return merge({left, right, overlapping});
}

std::vector<Case> cases() {
  return {{"box", triangulate(Box{{0.3, 0.1, 0.02}})},
          {"ball", triangulate(Sphere{0.08}, 40)},
          {"rod", triangulate(Cylinder{0.01, 0.5}, 20)},
          {"torus", torus(0.1, 0.03)},
          {"mug", mug()},
          {"cavity", with_cavity()},
          {"parts", two_parts()},
          {"open", open_box(), false},
          {"flat", sheet(0.3, 0.2), false},
          {"sliver", sheet(0.3, 1e-7), false}};
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

/// Meshes of the laboratory's robot and of scanned objects.
std::vector<std::shared_ptr<const TriangleMesh>> real_meshes() {
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  std::set<std::shared_ptr<const TriangleMesh>> meshes;
  for (const char* file : {"paper_lab_ur5_allegro_right_visual.yaml", "example_ur5_allegro_right.yaml"}) {
    for (const Link& link : load_robot(fs::path(OPPONENS_SOURCE_DIR "/tests/data/robots") / file).links) {
      for (const Geometry& geometry : link.collision) {
        if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&geometry.shape)) meshes.insert(*mesh);
      }
    }
  }
  const fs::path objects = OPPONENS_SHARED_DATA "/data/objects";
  for (const char* name : {"ycb/065-g_cups/065-g_cups.obj", "ycb/011_banana/011_banana.obj",
                           "ycb/035_power_drill/035_power_drill.obj", "graspit/mug.obj", "mbm_pregrasp/mug.stl"}) {
    if (fs::exists(objects / name)) meshes.insert(load_mesh(objects / name));
  }
  return {meshes.begin(), meshes.end()};
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
