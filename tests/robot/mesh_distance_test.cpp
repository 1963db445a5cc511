// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_distance.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/bounding_volume_tree.hpp"
#include "robot/mesh.hpp"
#include "robot/narrow_phase.hpp"
#include "tests/support/sample_count.hpp"

namespace opponens::robot {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using CgalTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>>>;

/// The independent oracle: CGAL's tree and its exact ray parity.
struct Oracle {
  explicit Oracle(const TriangleMesh& mesh)
      : surface(convert(mesh)), tree(faces(surface).begin(), faces(surface).end(), surface), side(tree) {
    tree.accelerate_distance_queries();
  }

  static SurfaceMesh convert(const TriangleMesh& mesh) {
    SurfaceMesh surface;
    for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
      surface.add_vertex({mesh.vertices(0, i), mesh.vertices(1, i), mesh.vertices(2, i)});
    }
    using Vertex = SurfaceMesh::Vertex_index;
    for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
      const auto face = surface.add_face(Vertex(static_cast<unsigned>(mesh.triangles(0, i))),
                                         Vertex(static_cast<unsigned>(mesh.triangles(1, i))),
                                         Vertex(static_cast<unsigned>(mesh.triangles(2, i))));
      EXPECT_NE(face, SurfaceMesh::null_face());
    }
    return surface;
  }

  double signed_distance(const Eigen::Vector3d& p) const {
    const Kernel::Point_3 point(p.x(), p.y(), p.z());
    const double distance = std::sqrt(tree.squared_distance(point));
    return side(point) == CGAL::ON_BOUNDED_SIDE ? -distance : distance;
  }

  SurfaceMesh surface;
  CgalTree tree;
  CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side;
};

std::shared_ptr<const TriangleMesh> share(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

Eigen::Vector3d random_point(const TriangleMesh& mesh, double spread, Rng& rng) {
  const auto f = static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(mesh.triangles.cols())));
  const double u = rng.uniform();
  const double v = rng.uniform() * (1.0 - u);
  const Eigen::Vector3d on = mesh.vertices.col(mesh.triangles(0, f)) * (1 - u - v) +
                             mesh.vertices.col(mesh.triangles(1, f)) * u + mesh.vertices.col(mesh.triangles(2, f)) * v;
  return on + spread * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
}

/// A mesh with creases, thin walls and vertices of many triangles.
TriangleMesh jagged() {
  TriangleMesh mesh = revolve({{0.05, 0.0}, {0.01, 0.02}, {0.06, 0.025}, {0.005, 0.1}, {0.04, 0.1}, {0.0, 0.11}}, 17);
  return mesh;
}

double brute_force(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f));
    const TrianglePoint on = nearest_on_triangle(a, mesh.vertices.col(mesh.triangles(1, f)) - a,
                                                 mesh.vertices.col(mesh.triangles(2, f)) - a, p);
    best = std::min(best, (p - on.point).norm());
  }
  return best;
}

TEST(MeshDistance, EqualsBruteForce) {
  Rng rng(11);
  for (const TriangleMesh& mesh : {jagged(), triangulate(Sphere{0.3}, 24), triangulate(Box{{0.1, 0.2, 0.3}})}) {
    const MeshDistance distance(share(mesh));
    for (int i = 0; i < sample_count(2000); ++i) {
      const Eigen::Vector3d p = random_point(mesh, i % 2 == 0 ? 0.005 : 0.3, rng);
      EXPECT_NEAR(std::abs(distance.signed_distance(p)), brute_force(mesh, p), 1e-12);
    }
  }
}

TEST(MeshDistance, AgreesWithCgal) {
  Rng rng(12);
  for (const TriangleMesh& mesh : {jagged(), triangulate(Box{{0.1, 0.2, 0.3}}), triangulate(Cylinder{0.1, 0.1}, 31)}) {
    const MeshDistance distance(share(mesh));
    const Oracle oracle(mesh);
    int inside = 0;
    for (int i = 0; i < sample_count(4000); ++i) {
      const Eigen::Vector3d p = random_point(mesh, i % 2 == 0 ? 0.003 : 0.1, rng);
      const double expected = oracle.signed_distance(p);
      EXPECT_NEAR(distance.signed_distance(p), expected, 1e-12) << p.transpose();
      inside += expected < 0.0 ? 1 : 0;
    }
    EXPECT_GT(inside, sample_count(400));  // both signs were seen
  }
}

TEST(MeshDistance, AgreesWithCgalOnARealObject) {
  const std::filesystem::path file =
      std::filesystem::path(OPPONENS_SHARED_DATA) / "data/objects/ycb/011_banana/011_banana.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  Rng rng(13);
  const auto mesh = load_mesh(file);
  const MeshDistance distance(mesh);
  const Oracle oracle(*mesh);
  for (int i = 0; i < sample_count(5000); ++i) {
    const Eigen::Vector3d p = random_point(*mesh, 0.01, rng);
    EXPECT_NEAR(distance.signed_distance(p), oracle.signed_distance(p), 1e-12) << p.transpose();
  }
}

TEST(MeshDistance, BoxByHand) {
  const MeshDistance box(share(triangulate(Box{{2, 4, 6}})));
  const auto above = box.query({0.3, 0.2, 4});
  EXPECT_DOUBLE_EQ(above.distance, 1.0);
  EXPECT_TRUE(above.point.isApprox(Eigen::Vector3d(0.3, 0.2, 3)));
  EXPECT_TRUE(above.gradient.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_DOUBLE_EQ(box.signed_distance({0.9, 0, 0}), -0.1);
  EXPECT_TRUE(box.query({0.9, 0, 0}).gradient.isApprox(Eigen::Vector3d::UnitX()));
  const auto corner = box.query({2, 3, 4});
  EXPECT_NEAR(corner.distance, std::sqrt(3.0), 1e-15);
  EXPECT_TRUE(corner.gradient.isApprox(Eigen::Vector3d::Ones().normalized()));
  const auto on = box.query({1, 0.5, 0.5});
  EXPECT_NEAR(on.distance, 0.0, 1e-15);
  EXPECT_TRUE(on.gradient.isApprox(Eigen::Vector3d::UnitX()));
  // On the edge itself the gradient is the mean of the two faces.
  EXPECT_TRUE(box.query({1, 2, 0.1}).gradient.isApprox(Eigen::Vector3d(1, 1, 0).normalized()));
  EXPECT_THROW(box.query(Eigen::Vector3d::Constant(std::nan(""))), std::invalid_argument);
  EXPECT_THROW(MeshDistance(nullptr), std::invalid_argument);
  EXPECT_THROW(MeshDistance(share(TriangleMesh{})), std::invalid_argument);
}

TEST(MeshDistance, GradientMatchesDifferences) {
  Rng rng(14);
  const TriangleMesh mesh = jagged();
  const MeshDistance distance(share(mesh));
  const double h = 1e-7;
  int smooth = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = random_point(mesh, 0.01, rng);
    const auto at = distance.query(p);
    EXPECT_NEAR(at.gradient.norm(), 1.0, 1e-9);
    Eigen::Vector3d difference;
    bool same = true;  // on the medial axis the gradient jumps
    for (int k = 0; k < 3; ++k) {
      const auto up = distance.query(p + h * Eigen::Vector3d::Unit(k));
      const auto down = distance.query(p - h * Eigen::Vector3d::Unit(k));
      difference[k] = (up.distance - down.distance) / (2 * h);
      same = same && (up.point - down.point).norm() < 1e-5;
    }
    if (!same || std::abs(at.distance) < 1e-5) continue;
    ++smooth;
    EXPECT_LT((difference - at.gradient).norm(), 1e-4) << p.transpose();
  }
  EXPECT_GT(smooth, 400);
}

TEST(MeshDistance, TouchingSolidsKeepTheirSigns) {
  // Two boxes that share exactly one edge, and two that share one vertex: there no normal tells inside from outside.
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 1, 1)}) {
    TriangleMesh mesh = triangulate(Box{{1, 1, 1}});
    const TriangleMesh one = mesh;
    mesh.vertices.conservativeResize(3, 16);
    mesh.vertices.rightCols(8) = one.vertices.colwise() + shift;
    mesh.triangles.conservativeResize(3, 24);
    mesh.triangles.rightCols(12) = one.triangles.array() + 8;
    for (Eigen::Index i = 0; i < 24; ++i) {
      for (int k = 0; k < 3; ++k) {
        for (int v = 0; v < 8; ++v) {
          if (mesh.vertices.col(v) == mesh.vertices.col(mesh.triangles(k, i))) mesh.triangles(k, i) = v;
        }
      }
    }
    ASSERT_EQ(component_seeds(mesh).size(), 1U);
    EXPECT_TRUE(is_closed(mesh));
    const MeshDistance distance(share(mesh));
    Rng rng(15);
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d p =
          Eigen::Vector3d::Constant(0.5) + 0.2 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      const bool inside = p.cwiseAbs().maxCoeff() < 0.5 || (p - shift).cwiseAbs().maxCoeff() < 0.5;
      EXPECT_EQ(distance.inside(p), inside) << p.transpose();
    }
  }
}

TEST(MeshDistance, SurvivesTrianglesWithoutArea) {
  // A closed box with one edge split by a vertex that only a sliver of no area uses.
  TriangleMesh mesh = triangulate(Box{{2, 2, 2}});
  mesh.vertices.conservativeResize(3, 9);
  mesh.vertices.col(8) = 0.5 * (mesh.vertices.col(0) + mesh.vertices.col(2));
  mesh.triangles.col(0) = Eigen::Vector3i(0, 8, 3);  // was 0 2 3
  mesh.triangles.conservativeResize(3, 14);
  mesh.triangles.col(12) = Eigen::Vector3i(8, 2, 3);
  mesh.triangles.col(13) = Eigen::Vector3i(0, 2, 8);
  ASSERT_TRUE(is_closed(mesh));
  const MeshDistance distance(share(mesh));
  Rng rng(16);
  for (int i = 0; i < sample_count(2000); ++i) {
    const Eigen::Vector3d p = 1.2 * Eigen::Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    const Eigen::Vector3d over = p.cwiseAbs() - Eigen::Vector3d::Ones();
    const double expected = over.cwiseMax(0.0).norm() + std::min(over.maxCoeff(), 0.0);
    EXPECT_NEAR(distance.signed_distance(p), expected, 1e-12) << p.transpose();
  }
}

TEST(MeshDistance, OneTriangleIsEnough) {
  TriangleMesh mesh;
  mesh.vertices = Eigen::Matrix3d::Identity();
  mesh.triangles.resize(3, 1);
  mesh.triangles << 0, 1, 2;
  const MeshDistance distance(share(mesh));
  EXPECT_NEAR(distance.signed_distance({1, 1, 1}), 2.0 / std::sqrt(3.0), 1e-15);
}

using Eigen::Isometry3d, Eigen::Vector3d;

/// The least signed distance of the vertices of one mesh from another.
double nearest_vertex(const TriangleMesh& from, const Isometry3d& X, const MeshDistance& to) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& p : from.vertices.colwise()) nearest = std::min(nearest, to.signed_distance(X * p));
  return nearest;
}

double longest_edge(const TriangleMesh& mesh) {
  const auto corners = [&](int k) -> Eigen::Matrix3Xd { return mesh.vertices(Eigen::all, mesh.triangles.row(k)); };
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, (corners(k) - corners((k + 1) % 3)).colwise().norm().maxCoeff());
  }
  return longest;
}

/// FCL between two meshes against signed distances of vertices from our own tree. The least over the vertices of both
/// bounds the separation from above; less the longest edge from below, since no surface point is further from a vertex.
/// A part moved by less than its separation stays free.
TEST(MeshDistance, BoundsTheSeparationOfLaboratoryMeshes) {
  const std::filesystem::path data = OPPONENS_SHARED_DATA "/data";
  const auto meshes = data / "robots/paper_lab_ur5_allegro/meshes";
  const auto object = data / "objects/ycb/006_mustard_bottle/006_mustard_bottle.obj";
  if (!exists(meshes) || !exists(object)) GTEST_SKIP() << meshes << " or " << object << " is absent";
  const auto scale = Vector3d::Constant(0.001);
  const auto bottle_mesh = load_mesh(object);
  const CollisionShape bottle(bottle_mesh);
  const MeshDistance to_bottle(bottle_mesh);
  Rng rng(36);
  int hits = 0;
  for (const char* name : {"AllegroHand_right_base_link_right.stl", "AllegroHand_right_link_1_0.stl"}) {
    const auto mesh = load_mesh(meshes / name, scale);
    const CollisionShape part(mesh);
    const MeshDistance to_part(mesh);
    EXPECT_FALSE(part.open_surface());
    const double edge = std::max(longest_edge(*mesh), longest_edge(*bottle_mesh));
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(i));
      Isometry3d X(Eigen::Translation3d(0.06 * rng.normal(), 0.06 * rng.normal(), 0.1 + 0.06 * rng.normal()));
      X.linear() =
          Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized().toRotationMatrix();
      const double above =
          std::min(nearest_vertex(*mesh, X, to_bottle), nearest_vertex(*bottle_mesh, X.inverse(), to_part));
      const bool hit = intersect(part, X, bottle, Isometry3d::Identity());
      const double distance = separation(part, X, bottle, Isometry3d::Identity());
      hits += hit ? 1 : 0;
      EXPECT_TRUE(hit || above > -1e-9) << above;
      EXPECT_LE(distance, std::max(above, 0.0) + 1e-9);
      EXPECT_GE(distance, above - edge);
      if (hit) continue;
      EXPECT_GT(distance, 0.0);
      const Vector3d way = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
      EXPECT_FALSE(intersect(part, Eigen::Translation3d(0.999 * distance * way) * X, bottle, Isometry3d::Identity()));
    }
  }
  EXPECT_TRUE(hits > 10 && hits < 110) << hits;
  // A finger wholly inside the bottle collides.
  const CollisionShape finger(load_mesh(meshes / "AllegroHand_right_link_1_0.stl", scale));
  EXPECT_TRUE(intersect(finger, Isometry3d(Eigen::Translation3d(-0.015, -0.02, 0.06)), bottle, Isometry3d::Identity()));
}

}  // namespace
}  // namespace opponens::robot
