// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh_check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"
#include "robot/mesh_repair.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

TriangleMesh cube(double edge = 0.1) { return triangulate(Box{Eigen::Vector3d::Constant(edge)}); }
TriangleMesh ball() { return triangulate(Sphere{0.05}, 48); }

void drop_triangles(TriangleMesh& mesh, const std::vector<Eigen::Index>& dropped) {
  Eigen::Index kept = 0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    if (std::find(dropped.begin(), dropped.end(), f) != dropped.end()) continue;
    mesh.triangles.col(kept++) = mesh.triangles.col(f).eval();
  }
  mesh.triangles.conservativeResize(3, kept);
}

void turn(TriangleMesh& mesh, Eigen::Index f) { std::swap(mesh.triangles(0, f), mesh.triangles(1, f)); }

void append(TriangleMesh& mesh, const TriangleMesh& other, const Eigen::Vector3d& offset) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = offset;
  mesh = merge({{std::make_shared<const TriangleMesh>(mesh)}, {std::make_shared<const TriangleMesh>(other), X}});
}

/// Every triangle with three vertices of its own, as an STL file has it.
TriangleMesh as_soup(const TriangleMesh& mesh) {
  TriangleMesh soup;
  soup.vertices.resize(3, 3 * mesh.triangles.cols());
  soup.triangles.resize(3, mesh.triangles.cols());
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      soup.vertices.col(3 * f + k) = mesh.vertices.col(mesh.triangles(k, f));
      soup.triangles(k, f) = static_cast<int>(3 * f + k);
    }
  }
  return soup;
}

/// What repair makes of a mesh, required to be without a defect.
RepairedMesh must_repair(const TriangleMesh& mesh) {
  const Result<RepairedMesh> result = repair_mesh(mesh);
  EXPECT_TRUE(result.has_value());
  const MeshReport report = check_mesh(result->mesh, true);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(defects(report), std::vector<std::string>{});
  return *result;
}

TEST(MeshCheck, ACleanMeshHasNoDefect) {
  for (const TriangleMesh& mesh : {cube(), ball(), triangulate(Cylinder{0.03, 0.2})}) {
    const MeshReport report = check_mesh(mesh, true);
    EXPECT_EQ(defects(report), std::vector<std::string>{}) << mesh.source;
    EXPECT_TRUE(report.closed());
    EXPECT_EQ(report.components, 1);
    EXPECT_FALSE(report.soup);
    EXPECT_EQ(report.self_intersections, 0);
    EXPECT_TRUE(must_repair(mesh).changes.empty());
  }
}

TEST(MeshCheck, ASoupIsMergedAndNoDefect) {
  const TriangleMesh soup = as_soup(cube());
  const MeshReport report = check_mesh(soup);
  EXPECT_TRUE(report.soup);
  EXPECT_EQ(report.vertices, 8);
  EXPECT_EQ(report.repeated_vertices, 28);
  EXPECT_TRUE(report.closed());
  EXPECT_TRUE(defects(report).empty());
  EXPECT_NEAR(mass_properties(must_repair(soup).mesh).volume, 1e-3, 1e-15);
}

TEST(MeshCheck, AHoleIsMeasuredAndFilled) {
  TriangleMesh mesh = cube();
  drop_triangles(mesh, {0, 1});  // the bottom
  const MeshReport report = check_mesh(mesh);
  ASSERT_EQ(report.holes.size(), 1U);
  EXPECT_EQ(report.holes[0].edges, 4);
  EXPECT_NEAR(report.holes[0].length, 0.4, 1e-12);
  EXPECT_EQ(report.open_components, 1);
  EXPECT_EQ(defects(report), std::vector<std::string>{"1 hole (the longest rim has 4 edges, 0.4 m)"});
  const RepairedMesh repaired = must_repair(mesh);
  EXPECT_EQ(repaired.changes, std::vector<std::string>{"1 holes filled with 2 triangles"});
  EXPECT_NEAR(mass_properties(repaired.mesh).volume, 1e-3, 1e-15);
}

TEST(MeshCheck, TwoHolesAreTwo) {
  TriangleMesh mesh = ball();
  drop_triangles(mesh, {0, 500});
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.holes.size(), 2U);
  EXPECT_GE(report.holes[0].length, report.holes[1].length);
  EXPECT_EQ(must_repair(mesh).mesh.triangles.cols(), ball().triangles.cols());
}

TEST(MeshCheck, TurnedTrianglesAreTheMinority) {
  TriangleMesh mesh = ball();
  for (const Eigen::Index f : {3, 77, 200, 201}) turn(mesh, f);
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.flipped_triangles, 4);
  EXPECT_TRUE(report.orientable);
  EXPECT_EQ(report.open_components, 1);
  EXPECT_NEAR(mass_properties(must_repair(mesh).mesh).volume, mass_properties(ball()).volume, 1e-12);
}

TEST(MeshCheck, APartInsideOutIsToldFromACavity) {
  TriangleMesh inverted = ball();
  for (Eigen::Index f = 0; f < inverted.triangles.cols(); ++f) turn(inverted, f);
  EXPECT_EQ(check_mesh(inverted).inside_out, 1);
  EXPECT_EQ(check_mesh(inverted).cavities, 0);
  EXPECT_GT(mass_properties(must_repair(inverted).mesh).volume, 0.0);
  TriangleMesh hollow = cube(0.3);
  append(hollow, inverted, Eigen::Vector3d::Zero());
  const MeshReport report = check_mesh(hollow, true);
  EXPECT_EQ(report.inside_out, 0);
  EXPECT_EQ(report.cavities, 1);
  EXPECT_EQ(report.components, 2);
  EXPECT_TRUE(defects(report).empty());
  EXPECT_NEAR(mass_properties(must_repair(hollow).mesh).volume, 0.027 - mass_properties(ball()).volume, 1e-12);
}

TEST(MeshCheck, NonManifoldEdgesAndVertices) {
  // Two cubes that share an edge: its four triangles.
  TriangleMesh by_edge = cube();
  append(by_edge, cube(), {0.1, 0.1, 0.0});
  const MeshReport edge = check_mesh(by_edge);
  EXPECT_EQ(edge.nonmanifold_edges, 1);
  EXPECT_EQ(edge.nonmanifold_vertices, 0);  // at its ends the cubes share more than the vertex
  TriangleMesh by_vertex = cube();
  append(by_vertex, cube(), {0.1, 0.1, 0.1});
  const MeshReport vertex = check_mesh(by_vertex);
  EXPECT_EQ(vertex.nonmanifold_edges, 0);
  EXPECT_EQ(vertex.nonmanifold_vertices, 1);
  // A third wing on an edge of the cube.
  TriangleMesh wing = cube();
  wing.vertices.conservativeResize(3, 9);
  wing.vertices.col(8) << 0.2, 0.2, 0.2;
  wing.triangles.conservativeResize(3, 13);
  wing.triangles.col(12) << 0, 1, 8;
  const MeshReport report = check_mesh(wing);
  EXPECT_EQ(report.nonmanifold_edges, 1);
  EXPECT_FALSE(report.holes.empty());
  EXPECT_EQ(report.open_components, 1);
}

TEST(MeshCheck, CubesThatShareAnEdgeAreCutApart) {
  TriangleMesh mesh = cube();
  append(mesh, cube(), {0.1, 0.1, 0.0});
  const Result<RepairedMesh> repaired = repair_mesh(mesh);
  ASSERT_TRUE(repaired.has_value());
  EXPECT_TRUE(is_closed(repaired->mesh));
  EXPECT_NEAR(mass_properties(repaired->mesh).volume, 2e-3, 1e-15);
}

TEST(MeshCheck, DuplicatesAndDegenerateTriangles) {
  TriangleMesh mesh = cube();
  mesh.vertices.conservativeResize(3, 9);
  mesh.vertices.col(8) = 0.5 * (mesh.vertices.col(0) + mesh.vertices.col(1));
  mesh.triangles.conservativeResize(3, 15);
  mesh.triangles.col(12) = mesh.triangles.col(3);
  mesh.triangles.col(13) << 0, 1, 8;  // on a line
  mesh.triangles.col(14) << 2, 2, 5;  // a corner twice
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.duplicate_triangles, 1);
  EXPECT_EQ(report.degenerate_triangles, 2);
  const RepairedMesh repaired = must_repair(mesh);
  EXPECT_EQ(repaired.changes,
            (std::vector<std::string>{"2 triangles without area dropped", "1 repeated triangles dropped"}));
  EXPECT_EQ(repaired.mesh.triangles.cols(), 12);
}

TEST(MeshCheck, AFinIsDroppedAndASheetIsNot) {
  TriangleMesh mesh = ball();
  const Eigen::Index v = mesh.vertices.cols();
  mesh.vertices.conservativeResize(3, v + 1);
  const int a = mesh.triangles(0, 700);
  const int b = mesh.triangles(1, 700);
  mesh.vertices.col(v) = 1.01 * mesh.vertices.col(a);
  const Eigen::Index f = mesh.triangles.cols();
  mesh.triangles.conservativeResize(3, f + 2);
  mesh.triangles.col(f) << a, b, static_cast<int>(v);
  mesh.triangles.col(f + 1) << b, a, static_cast<int>(v);
  EXPECT_EQ(check_mesh(mesh).duplicate_triangles, 1);
  EXPECT_EQ(check_mesh(mesh).nonmanifold_edges, 1);
  const RepairedMesh repaired = must_repair(mesh);
  EXPECT_EQ(repaired.changes, std::vector<std::string>{"1 double sheets without volume dropped"});
  EXPECT_EQ(repaired.mesh.triangles.cols(), ball().triangles.cols());
  // A plate drawn from both sides is all double sheet: something of it has to stay.
  TriangleMesh plate;
  plate.vertices.resize(3, 4);
  plate.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  plate.triangles.resize(3, 4);
  plate.triangles << 0, 0, 2, 3, 1, 2, 1, 2, 2, 3, 0, 0;
  const Result<RepairedMesh> sheet = repair_mesh(plate);
  ASSERT_TRUE(sheet.has_value());
  EXPECT_GE(sheet->mesh.triangles.cols(), 2);
}

TEST(MeshCheck, ACrackIsClosed) {
  TriangleMesh mesh = cube();
  // One corner of two triangles lies 10 nm beside: not equal, so the surface is torn.
  mesh.vertices.conservativeResize(3, 9);
  mesh.vertices.col(8) = mesh.vertices.col(7) + Eigen::Vector3d(1e-8, 0.0, 0.0);
  for (Eigen::Index f = 0; f < 6; ++f) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles(k, f) == 7) mesh.triangles(k, f) = 8;
    }
  }
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.close_vertices, 1);
  EXPECT_FALSE(report.closed());
  EXPECT_NEAR(mass_properties(must_repair(mesh).mesh).volume, 1e-3, 1e-9);
}

TEST(MeshCheck, CrossingTrianglesAreCounted) {
  TriangleMesh apart = cube();
  append(apart, cube(), {0.2, 0.0, 0.0});
  EXPECT_EQ(check_mesh(apart, true).self_intersections, 0);
  TriangleMesh crossing = cube();
  append(crossing, cube(), {0.05, 0.04, 0.03});
  EXPECT_GT(check_mesh(crossing, true).self_intersections, 0);
  EXPECT_FALSE(check_mesh(crossing).self_intersections.has_value());
  // Two triangles of one edge folded onto each other.
  TriangleMesh fold;
  fold.vertices.resize(3, 4);
  fold.vertices << 0, 1, 0.2, 0.7, 0, 0, 1, 1, 0, 0, 0, 0;
  fold.triangles.resize(3, 2);
  fold.triangles << 0, 1, 1, 0, 2, 3;
  EXPECT_EQ(count_self_intersections(fold), 1);
  fold.vertices(1, 3) = -1.0;  // laid flat
  EXPECT_EQ(count_self_intersections(fold), 0);
  fold.vertices(1, 3) = 0.0;  // one corner moved through the other triangle's plane and back
  fold.vertices(2, 3) = 1.0;
  EXPECT_EQ(count_self_intersections(fold), 0);
}

TEST(MeshCheck, AMoebiusStripHasOneSide) {
  constexpr int kSegments = 12;
  TriangleMesh strip;
  strip.vertices.resize(3, 2 * kSegments);
  strip.triangles.resize(3, 2 * kSegments);
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSegments;
    const Eigen::Vector3d middle(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d across = std::cos(angle / 2) * middle + std::sin(angle / 2) * Eigen::Vector3d::UnitZ();
    strip.vertices.col(2 * i) = middle - 0.2 * across;
    strip.vertices.col(2 * i + 1) = middle + 0.2 * across;
    // After one round the two rims have changed places.
    const int next_low = i + 1 < kSegments ? 2 * (i + 1) : 1;
    const int next_high = i + 1 < kSegments ? 2 * (i + 1) + 1 : 0;
    strip.triangles.col(2 * i) << 2 * i, next_low, 2 * i + 1;
    strip.triangles.col(2 * i + 1) << next_low, next_high, 2 * i + 1;
  }
  EXPECT_FALSE(check_mesh(strip).orientable);
}

TEST(MeshCheck, SuspiciousSizesSuggestAUnit) {
  const MeshReport wide = check_mesh(cube(200.0));
  EXPECT_EQ(wide.likely_scales, (std::vector<double>{0.001, 0.01}));
  ASSERT_EQ(defects(wide).size(), 1U);
  EXPECT_EQ(defects(wide)[0],
            "is 200 m long: a wrong unit? millimetres read as metres it would be 0.2 m; centimetres read as metres it "
            "would be 2 m");
  const MeshReport tiny = check_mesh(cube(0.0002));
  EXPECT_EQ(tiny.likely_scales.front(), 1000.0);
  EXPECT_NE(defects(tiny)[0].find("metres read as millimetres it would be 0.2 m"), std::string::npos);
  EXPECT_TRUE(defects(check_mesh(cube(3.0))).empty());  // a cupboard
}

TEST(MeshRepair, NothingLeftIsAFailure) {
  TriangleMesh line;
  line.vertices.resize(3, 3);
  line.vertices << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  line.triangles.resize(3, 1);
  line.triangles << 0, 1, 2;
  const Result<RepairedMesh> result = repair_mesh(line);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, FailureCode::degenerate);
}

TEST(MeshRepair, SimplificationIsBoundedByWhatItSays) {
  const TriangleMesh fine = triangulate(Sphere{0.05}, 96);
  const Result<TriangleMesh> coarse = simplify_mesh(fine, 300);
  ASSERT_TRUE(coarse.has_value());
  EXPECT_NEAR(static_cast<double>(coarse->triangles.cols()), 300.0, 4.0);
  EXPECT_TRUE(is_closed(*coarse));
  const SurfaceChange change = surface_change(fine, *coarse);
  EXPECT_GT(change.from_before, 1e-5);
  EXPECT_LT(change.bound(), 0.005);
  // Independent: denser points of the old surface, none further outside of the new solid than was said.
  const MeshDistance distance(std::make_shared<const TriangleMesh>(*coarse));
  double outside = 0.0;
  for (const Eigen::Vector3d& p : surface_samples({std::make_shared<const TriangleMesh>(fine)}, 0.0004)) {
    outside = std::max(outside, distance.signed_distance(p));
  }
  EXPECT_GE(change.shrunk_bound(), outside);
  EXPECT_GT(outside, 0.0);
  const TriangleMesh by_edge = [] {
    TriangleMesh mesh = cube();
    append(mesh, cube(), {0.1, 0.1, 0.0});
    return merge_equal_vertices(mesh);
  }();
  EXPECT_FALSE(simplify_mesh(by_edge, 10).has_value());
}

TEST(MeshRepair, SurfaceChangeSeesAShiftBothWays) {
  TriangleMesh shifted = cube();
  shifted.vertices.row(0).array() += 0.003;
  const SurfaceChange change = surface_change(cube(), shifted);
  EXPECT_NEAR(change.from_before, 0.003, 1e-12);
  EXPECT_NEAR(change.from_after, 0.003, 1e-12);
  EXPECT_NEAR(change.shrunk, 0.003, 1e-12);
  TriangleMesh grown = cube(0.11);
  EXPECT_EQ(surface_change(cube(), grown).shrunk, 0.0);
  // A part that is lost is seen from before only.
  TriangleMesh two = cube();
  append(two, cube(), {0.5, 0.0, 0.0});
  const SurfaceChange lost = surface_change(two, cube());
  EXPECT_NEAR(lost.from_before, 0.5, 1e-12);
  EXPECT_NEAR(lost.from_after, 0.0, 1e-12);
}

TEST(MeshCheck, SceneWarningsNameBodyAndDefect) {
  TriangleMesh open = cube();
  drop_triangles(open, {4});
  open.source = "open.stl";
  Scene scene;
  scene.bodies.push_back({"mug", Eigen::Isometry3d::Identity(), {{std::make_shared<const TriangleMesh>(open)}}});
  scene.bodies.push_back({"ball", Eigen::Isometry3d::Identity(), {{Sphere{0.1}}}});
  const std::vector<std::string> warnings = mesh_warnings(scene);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].find("body 'mug': mesh open.stl: 1 hole"), 0U) << warnings[0];
}

TEST(MeshCheck, TheYcbMeshesAreClosed) {
  const fs::path root = fs::path(OPPONENS_SHARED_DATA) / "data/objects";
  if (!fs::exists(root)) GTEST_SKIP() << "needs " << root;
  int checked = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".stl" && extension != ".obj" && extension != ".STL") continue;
    const MeshReport report = check_mesh(read_mesh(entry.path()));
    EXPECT_GT(report.triangles, 0);
    ++checked;
    if (report.triangles == 16384) {
      EXPECT_TRUE(report.closed()) << entry.path();
    }
  }
  EXPECT_GT(checked, 10);
}

}  // namespace
}  // namespace opponens::robot
