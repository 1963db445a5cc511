// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "experiments/collision_equality/comparisons.hpp"
#include "made_robots.hpp"
#include "robot/bounding_volume_tree.hpp"
#include "robot/convex_apart.hpp"
#include "robot/mesh_cover.hpp"
#include "robot_test.hpp"
#include "solid_points.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kDepth = 1e-5;

/// Whether no plane was found between a point and a piece.
bool may_hold(const HullVertices& piece, const SphereTree::Node& node, const Vector3d& p) {
  const ConvexSolid point{Sphere{1e-9}, Vector3d::Zero()};
  return convex_relation({&piece, node.center}, point, at(p.x(), p.y(), p.z()), 0.0, 0.0) != Convex::apart;
}

/// Whether a way through balls that contain p leads to a piece that does. It must for every point of the surface.
bool held(const MeshCover& cover, std::size_t index, const Vector3d& p) {
  const SphereTree::Node& node = cover.tree.nodes[index];
  if ((p - node.center).norm() > node.radius * (1.0 + 1e-12)) return false;
  if (node.children == 0) return cover.pieces[index].all.count > 0 && may_hold(cover.pieces[index], node, p);
  for (int child = 0; child < node.children; ++child) {
    if (held(cover, static_cast<std::size_t>(node.first_child + child), p)) return true;
  }
  return false;
}

int not_held(const MeshCover& cover, const std::vector<Vector3d>& points) {
  return static_cast<int>(
      std::count_if(points.begin(), points.end(), [&](const Vector3d& p) { return !held(cover, 0, p); }));
}

TEST(MeshPieces, ContainTheSurface) {
  Rng rng(1);
  for (const Case& c : cases()) {
    const MeshCover cover = mesh_cover(c.mesh);
    ASSERT_EQ(cover.pieces.size(), cover.tree.nodes.size());
    EXPECT_EQ(not_held(cover, surface_points(c.mesh, 2000, rng)), 0) << c.name;
  }
}

TEST(MeshPieces, ContainRealMeshes) {
  if (!std::filesystem::exists(OPPONENS_SHARED_DATA "/data/robots")) GTEST_SKIP() << "no " OPPONENS_SHARED_DATA;
  Rng rng(2);
  for (const auto& mesh : real_meshes()) {
    EXPECT_EQ(not_held(mesh_cover(*mesh), surface_points(*mesh, 1000, rng)), 0) << mesh->source;
  }
}

TEST(MeshPieces, SmallerOrFewerOnesWouldBeNoticed) {
  // The companion of the tests above.
  Rng rng(3);
  for (const Case& c : cases()) {
    if (c.name == "sliver") continue;  // narrower than the rounding of its pieces
    const MeshCover cover = mesh_cover(c.mesh);
    const std::vector<Vector3d> points = surface_points(c.mesh, 2000, rng);
    MeshCover smaller = cover;
    for (std::size_t i = 0; i < smaller.pieces.size(); ++i) {
      PaddedPoints& all = smaller.pieces[i].all;
      smaller.pieces[i].few = {};
      for (std::size_t k = 0; k < all.xyz.size(); ++k) {
        const auto middle = static_cast<float>(
            cover.tree.nodes[i].center[static_cast<Eigen::Index>(k / static_cast<std::size_t>(all.count))]);
        all.xyz[k] = middle + 0.9F * (all.xyz[k] - middle);
      }
    }
    EXPECT_GT(not_held(smaller, points), 0) << c.name;
    MeshCover fewer = cover;
    for (std::size_t i = fewer.pieces.size() * 3 / 4; i < fewer.pieces.size(); ++i) fewer.pieces[i] = {};
    EXPECT_GT(not_held(fewer, points), 0) << c.name;
  }
}

TEST(MeshPieces, AreOfPointsOnTheSurface) {
  for (const Case& c : cases()) {
    const BoundingVolumeTree surface(c.mesh);
    for (const HullVertices& piece : mesh_cover(c.mesh).pieces) {
      for (int i = 0; i < piece.all.count; ++i) {
        EXPECT_LE(std::sqrt(surface.nearest(piece.all.point(i)).squared_distance), piece.rounding) << c.name;
      }
    }
  }
}

/// Closed, hollow, open and in several parts.
std::vector<CollisionShape> shapes_of_cases() {
  std::vector<CollisionShape> shapes;
  for (const Case& c : cases()) shapes.emplace_back(mesh_of(c.mesh));
  return shapes;
}

Shape random_primitive(Rng& rng) {
  const double size = rng.uniform(0.02, 0.2);
  switch (rng.index(3)) {
    case 0:
      return Box{{size, size * rng.uniform(0.05, 1), size * rng.uniform(0.05, 1)}};
    case 1:
      return Sphere{0.5 * size};
    default:
      return Cylinder{0.3 * size, size};
  }
}

struct Verdicts {
  int apart = 0;        ///< told
  int truly_apart = 0;  ///< by more than a millimetre
  int hulls_apart = 0;
  int touching = 0;  ///< told
  int truly_touching = 0;
  int vertex_inside = 0;  ///< of a mesh, deep in a primitive: this must be told
};

/// Whether an extreme vertex of a mesh is a hundredth of a millimetre deeper in a primitive than it need be.
bool holds_a_vertex(const CollisionShape& primitive, const Isometry3d& X_WP, const CollisionShape& mesh,
                    const Isometry3d& X_WM) {
  constexpr double kDeeper = kDepth + 1e-5;
  const auto deep = [&](const Vector3d& p) {
    if (const auto* box = std::get_if<Box>(&primitive.shape())) {
      return (0.5 * box->size - p.cwiseAbs()).minCoeff() > kDeeper;
    }
    if (const auto* sphere = std::get_if<Sphere>(&primitive.shape())) return p.norm() < sphere->radius - kDeeper;
    const auto* cylinder = std::get_if<Cylinder>(&primitive.shape());
    return cylinder != nullptr && std::abs(p.z()) < 0.5 * cylinder->length - kDeeper &&
           p.head<2>().norm() < cylinder->radius - kDeeper;
  };
  for (int i = 0; i < mesh.hull().all.count; ++i) {
    if (deep(X_WP.inverse() * (X_WM * mesh.hull().all.point(i)))) return true;
  }
  return false;
}

/// What is told of two shapes, against the truth. Where the truth changes within a micrometre, either is refused.
void compare(const CollisionShape& a, const CollisionShape& b, const Isometry3d& X_WA, const Isometry3d& X_WB,
             Verdicts& sum) {
  const Solids told = pieces_relation(a, X_WA, b, X_WB, kCullMargin, kDepth);
  EXPECT_EQ(told, pieces_relation(a, X_WA, b, X_WB, kCullMargin, kDepth));
  const bool meet = intersect(a, X_WA, b, X_WB);
  if (told == Solids::apart) {
    EXPECT_FALSE(meet);
    const bool by_planes = a.pieces().empty() || b.pieces().empty();
    EXPECT_GT(separation(a, X_WA, b, X_WB), by_planes ? 0.5 * kCullMargin : 0.0);
  }
  EXPECT_TRUE(told != Solids::touching || meet);
  EXPECT_NE(pieces_relation(b, X_WB, a, X_WA, kCullMargin, kDepth), meet ? Solids::apart : Solids::touching);
  if (b.pieces().empty() && holds_a_vertex(b, X_WB, a, X_WA)) {
    ++sum.vertex_inside;
    EXPECT_EQ(told, Solids::touching);
  }
  sum.apart += told == Solids::apart ? 1 : 0;
  sum.touching += told == Solids::touching ? 1 : 0;
  sum.truly_touching += meet ? 1 : 0;
  if (!meet && separation(a, X_WA, b, X_WB) > 1e-3) ++sum.truly_apart;
  if (convex_apart(a, X_WA, b, X_WB, kCullMargin)) ++sum.hulls_apart;
}

/// On a random line towards each other, and next to the contact on it.
void compare_on_a_line(const CollisionShape& a, const CollisionShape& b, Rng& rng, Verdicts& sum) {
  const Isometry3d X_WA = random_pose(1.0, rng);
  Isometry3d X_WB = random_pose(1.0, rng);
  const Vector3d direction = random_direction(rng);
  const Vector3d aside = 0.3 * a.radius() * random_direction(rng);
  const auto place = [&](double x) { X_WB.translation() = X_WA * a.center() + aside + x * direction; };
  double near = 0.0;
  double far = 1.5 * (a.radius() + b.radius());
  place(rng.uniform(near, far));
  compare(a, b, X_WA, X_WB, sum);
  while (far - near > 1e-7) {
    const double middle = 0.5 * (near + far);
    place(middle);
    (intersect(a, X_WA, b, X_WB) ? near : far) = middle;
  }
  for (const double x : {near - 1e-4, near - 2e-5, near, far, far + 1e-6, far + 3e-6, far + 1e-4, far + 1e-3}) {
    place(x);
    compare(a, b, X_WA, X_WB, sum);
  }
}

TEST(MeshPieces, TwoMeshesAsTheTruth) {
  Rng rng(4);
  const std::vector<CollisionShape> all = shapes_of_cases();
  Verdicts sum;
  for (const CollisionShape& a : all) {
    for (const CollisionShape& b : all) {
      for (int i = 0; i < 6; ++i) compare_on_a_line(a, b, rng, sum);
    }
  }
  EXPECT_GT(sum.apart, sum.hulls_apart + 100);
  EXPECT_GT(sum.apart, sum.truly_apart * 9 / 10);
  // The truth is asked about few pairs of pieces, which settles nearly all.
  EXPECT_GT(sum.touching, sum.truly_touching * 9 / 10);
  EXPECT_GT(sum.truly_touching, 500);
}

TEST(MeshPieces, MeshesAndPrimitivesAsTheTruth) {
  Rng rng(5);
  Verdicts sum;
  for (const CollisionShape& mesh : shapes_of_cases()) {
    for (int i = 0; i < 60; ++i) compare_on_a_line(mesh, CollisionShape(random_primitive(rng)), rng, sum);
  }
  EXPECT_GT(sum.apart, sum.hulls_apart + 50);
  EXPECT_GT(sum.apart, sum.truly_apart * 9 / 10);
  EXPECT_GT(sum.touching, 100);
  EXPECT_GT(sum.vertex_inside, 100);
}

TEST(MeshPieces, LinkedRingsHolesAndCavities) {
  const CollisionShape ring(mesh_of(torus(0.1, 0.02)));
  const CollisionShape shell(mesh_of(with_cavity()));
  const CollisionShape ball(Shape(Sphere{0.02}));
  const CollisionShape meshed_ball(mesh_of(triangulate(Sphere{0.02}, 24)));
  const Isometry3d still = at(0, 0, 0);
  Isometry3d linked = at(0.1, 0, 0);
  linked.rotate(Eigen::AngleAxisd(1.5707963267948966, Vector3d::UnitX()));
  EXPECT_EQ(pieces_relation(ring, still, ring, linked, kCullMargin, kDepth), Solids::apart);
  for (const CollisionShape& inner : {ball, meshed_ball}) {
    EXPECT_EQ(pieces_relation(ring, still, inner, still, kCullMargin, kDepth), Solids::apart);
    EXPECT_EQ(pieces_relation(shell, still, inner, still, kCullMargin, kDepth), Solids::apart);
    // In the wall, which is solid: no surfaces meet.
    const Isometry3d wall = at(0, 0.075, 0);
    EXPECT_TRUE(intersect(shell, still, inner, wall));
    EXPECT_NE(pieces_relation(shell, still, inner, wall, kCullMargin, kDepth), Solids::apart);
  }
  EXPECT_EQ(pieces_relation(ring, still, ball, at(0.1, 0, 0), kCullMargin, kDepth),
            Solids::unknown);  // no vertex is in it
  EXPECT_EQ(pieces_relation(ball, at(0.1, 0, 0.01), ring, still, kCullMargin, kDepth), Solids::touching);
}

TEST(MeshPieces, CheckersOfRingsAndMugsGiveTheTruth) {
  // Links that hang in each other, so that their hulls overlap while they are apart.
  RobotBuilder builder({{mesh_of(torus(0.1, 0.02, 32))}});
  builder.add(0, JointType::prismatic, Vector3d::UnitX(), at(0.1, 0, 0), {});
  builder.add(1, JointType::revolute, Vector3d::UnitX(), at(0, 0, 0), {{mesh_of(torus(0.1, 0.02, 32))}});
  builder.add(2, JointType::revolute, Vector3d::UnitZ(), at(0.25, 0, 0), {});
  builder.add(3, JointType::prismatic, Vector3d::UnitY(), at(0, 0, 0), {{mesh_of(mug())}});
  for (Joint& joint : builder.robot.joints)
    joint.upper = -(joint.lower = joint.type == JointType::revolute ? -3 : -0.1);
  const RobotModel robot = builder.model();
  Scene scene;
  scene.bodies.push_back({"box", at(0.15, 0.28, 0.05), {{mesh_of(open_box())}}});
  scene.bodies.push_back({"rod", at(-0.03, 0.0, 0.1), {{Cylinder{0.01, 0.3}}}});
  const experiments::Subject subject(robot, scene);
  Rng rng(6);
  for (const auto compare : {experiments::compare_uniform, experiments::compare_motions, experiments::compare_contacts,
                             experiments::compare_flying, experiments::compare_flying_contacts}) {
    const experiments::Tally tally = compare(subject, 400, rng);
    EXPECT_EQ(tally.different, 0) << tally.example;
    EXPECT_GT(tally.free, 0);
    EXPECT_LT(tally.free, tally.configurations);
  }
}

}  // namespace
}  // namespace opponens::robot
