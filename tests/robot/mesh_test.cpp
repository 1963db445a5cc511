// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/mesh.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "core/rng.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

/// A directory of its own per test, removed afterwards.
class MeshFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("opponens_mesh_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

 private:
  fs::path folder_;
};

std::string binary_stl(const TriangleMesh& mesh, std::uint32_t announced) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&announced), 4);
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    float record[12] = {};
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        record[3 + 3 * k + axis] = static_cast<float>(mesh.vertices(axis, mesh.triangles(k, f)));
      }
    }
    bytes.append(reinterpret_cast<const char*>(record), sizeof(record));
    bytes.append(2, '\0');
  }
  return bytes;
}

/// The one-line message of the InputError that loading must throw.
std::string load_error(const fs::path& file) {
  try {
    load_mesh(file);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << file << " was accepted";
  return {};
}

void expect_same_box(const TriangleMesh& mesh, const Eigen::Vector3d& size) {
  EXPECT_EQ(mesh.vertices.cols(), 8);
  EXPECT_EQ(mesh.triangles.cols(), 12);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(mass_properties(mesh).volume, size.prod(), 1e-6 * size.prod());
}

TEST_F(MeshFiles, BinaryStlMergesTheRepeatedVertices) {
  const Eigen::Vector3d size(0.1, 0.2, 0.3);
  const TriangleMesh box = triangulate(Box{size});
  expect_same_box(*load_mesh(write("box.stl", binary_stl(box, 12))), size);
  expect_same_box(*load_mesh(write("box.STL", binary_stl(box, 12)), Eigen::Vector3d::Constant(0.001)), 0.001 * size);
}

TEST_F(MeshFiles, TextStlAndObjAndMirroringScale) {
  const fs::path stl =
      write("tetra.stl",
            "solid t\n"
            "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
            "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
            "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
            "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
            "endsolid t\n");
  const fs::path obj =
      write("tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 -0.0\nf 1 3 2\nf 5 2 4\nf 1 4 3\nf 2 3 4\n");
  for (const fs::path& file : {stl, obj}) {
    const auto mesh = load_mesh(file);
    EXPECT_EQ(mesh->vertices.cols(), 4) << file;
    EXPECT_TRUE(is_closed(*mesh)) << file;
    EXPECT_NEAR(mass_properties(*mesh).volume, 1.0 / 6.0, 1e-12) << file;
    EXPECT_NEAR(mass_properties(*load_mesh(file, {-1, 1, 2})).volume, 2.0 / 6.0, 1e-12) << file;
  }
}

TEST_F(MeshFiles, CollapsedTrianglesAreDropped) {
  const auto mesh = load_mesh(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\nf 1 2 4\n"));
  EXPECT_EQ(mesh->triangles.cols(), 1);
  EXPECT_NE(load_error(write("none.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n")).find("no triangles"),
            std::string::npos);
}

TEST_F(MeshFiles, BadFilesAreRefusedInOneLine) {
  const TriangleMesh box = triangulate(Box{{1, 1, 1}});
  EXPECT_NE(load_error(write("huge.stl", binary_stl(box, 4000000000U))).find("announces 4000000000"),
            std::string::npos);
  const std::string whole = binary_stl(box, 12);
  load_error(write("cut.stl", whole.substr(0, whole.size() - 30)));
  load_error(write("empty.stl", ""));
  load_error(write("empty.obj", ""));
  load_error(write("noise.obj", std::string(500, '\x7f')));
  load_error(write("points.obj", "v 0 0 0\nv 1 0 0\n"));
  load_error(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"));
  load_error(write("half.dae", "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\"><library_geom"));
  load_error(write("mesh.txt", "hello"));
  load_error(fs::temp_directory_path() / "opponens_absent.stl");
  TriangleMesh nan = box;
  nan.vertices(1, 3) = std::numeric_limits<double>::quiet_NaN();
  load_error(write("nan.stl", binary_stl(nan, 12)));
}

TEST(Mesh, RevolvedSolidsAreClosedWithTheVolumeOfTheirFrusta) {
  const int n = 24;
  // A regular n-gon inscribed in a circle of radius 1 has the area n/2 sin(2 pi / n).
  const double area = 0.5 * n * std::sin(2.0 * std::numbers::pi / n);
  const auto frustum = [&](double r, double s, double h) { return area * h * (r * r + r * s + s * s) / 3.0; };
  const TriangleMesh bottle = revolve({{0.03, 0.0}, {0.04, 0.1}, {0.01, 0.1}, {0.01, 0.2}, {0.0, 0.25}}, n);
  EXPECT_TRUE(is_closed(bottle));
  EXPECT_EQ(component_seeds(bottle).size(), 1U);
  const double volume = frustum(0.03, 0.04, 0.1) + frustum(0.01, 0.01, 0.1) + frustum(0.01, 0.0, 0.05);
  EXPECT_NEAR(mass_properties(bottle).volume, volume, 1e-15);
  EXPECT_NEAR(mass_properties(bottle).center_of_mass.head<2>().norm(), 0.0, 1e-12);
  for (const auto& profile : std::vector<std::vector<std::pair<double, double>>>{{{0.1, 0}},
                                                                                 {{0, 0}, {0, 1}},
                                                                                 {{0.1, 0}, {0, 0.5}, {0.1, 1}},
                                                                                 {{0.1, 1}, {0.1, 0}},
                                                                                 {{-0.1, 0}, {0.1, 1}},
                                                                                 {{0.1, 0}, {0.1, 0}, {0.1, 1}},
                                                                                 {{0.1, 0}, {0.2, 0}}}) {
    EXPECT_THROW(revolve(profile, n), std::invalid_argument);
  }
  EXPECT_THROW(revolve({{0.1, 0}, {0.1, 1}}, 2), std::invalid_argument);
}

TEST(Mesh, TriangulatedPrimitivesConvergeToTheirVolume) {
  const std::vector<std::pair<Shape, double>> shapes{
      {Box{{1, 2, 3}}, 6.0}, {Sphere{0.5}, std::numbers::pi / 6.0}, {Cylinder{0.5, 2.0}, std::numbers::pi / 2.0}};
  for (const auto& [shape, volume] : shapes) {
    for (const int segments : {16, 64}) {
      const TriangleMesh mesh = triangulate(shape, segments);
      EXPECT_TRUE(is_closed(mesh));
      const double missing = (volume - mass_properties(mesh).volume) / volume;
      EXPECT_GE(missing, -1e-12);
      // Inscribed n-gons lose 2 pi^2 / (3 n^2) of a disc; a sphere's meridians lose another pi^2 / n^2.
      EXPECT_LE(missing, 5.0 / 3.0 * std::numbers::pi * std::numbers::pi / (segments * segments));
    }
  }
}

TEST(Mesh, MassPropertiesMoveWithTheMesh) {
  Geometry box{Box{{0.1, 0.2, 0.3}}};
  box.X_BG = Eigen::Translation3d(5, -7, 9) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const MassProperties properties = mass_properties(merge({box}));
  EXPECT_NEAR(properties.volume, 0.006, 1e-14);
  EXPECT_NEAR((properties.center_of_mass - Eigen::Vector3d(5, -7, 9)).norm(), 0.0, 1e-12);
}

TEST(Mesh, ClosedMeansEveryEdgeCancels) {
  TriangleMesh open = triangulate(Box{{1, 1, 1}});
  open.triangles.conservativeResize(3, 11);
  EXPECT_FALSE(is_closed(open));
  TriangleMesh flipped = triangulate(Box{{1, 1, 1}});
  std::swap(flipped.triangles(0, 4), flipped.triangles(1, 4));
  EXPECT_FALSE(is_closed(flipped));
  EXPECT_FALSE(is_closed(TriangleMesh{}));
}

TEST(Mesh, ComponentsSplitAMergedMesh) {
  Geometry far{Cylinder{0.1, 0.2}};
  far.X_BG.translation().x() = 3.0;
  const TriangleMesh both = merge({{Box{{1, 1, 1}}}, far});
  const std::vector<int> seeds = component_seeds(both);
  ASSERT_EQ(seeds.size(), 2U);
  const std::vector<TriangleMesh> parts = components(both);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].triangles.cols(), 12);
  EXPECT_EQ(parts[0].triangles.cols() + parts[1].triangles.cols(), both.triangles.cols());
  EXPECT_LT(both.vertices(0, seeds[0]), 1.0);
  EXPECT_GT(both.vertices(0, seeds[1]), 2.0);
  EXPECT_NEAR(mass_properties(parts[1]).center_of_mass.x(), 3.0, 1e-12);
}

TEST(Mesh, SurfaceSamplesCoverAndKeepApart) {
  Rng rng(5);
  const double spacing = 0.01;
  for (const Shape& shape : std::vector<Shape>{Box{{0.03, 0.04, 0.05}}, Sphere{0.03}, Cylinder{0.02, 0.06},
                                               std::make_shared<TriangleMesh>(triangulate(Cylinder{0.02, 0.06}, 90))}) {
    Geometry geometry{shape};
    geometry.X_BG.translation() = Eigen::Vector3d(1, 2, 3);
    const std::vector<Eigen::Vector3d> samples = surface_samples(geometry, spacing);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((samples[i] - samples[j]).norm(), 0.5 * spacing * (1 - 1e-9));
      if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        EXPECT_NEAR((samples[i] - geometry.X_BG.translation()).norm(), sphere->radius, 1e-12);
      }
    }
    const TriangleMesh mesh = triangulate(shape, 200);
    for (int trial = 0; trial < 500; ++trial) {
      const auto f = static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(mesh.triangles.cols())));
      const double u = rng.uniform();
      const double v = rng.uniform() * (1.0 - u);
      const Eigen::Vector3d p = mesh.vertices.col(mesh.triangles(0, f)) * (1 - u - v) +
                                mesh.vertices.col(mesh.triangles(1, f)) * u +
                                mesh.vertices.col(mesh.triangles(2, f)) * v;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3d& s : samples) nearest = std::min(nearest, (geometry.X_BG * p - s).norm());
      EXPECT_LE(nearest, spacing);
    }
  }
  EXPECT_THROW(surface_samples({Sphere{1}}, 0.0), std::invalid_argument);
}

TEST(Mesh, RealObjectsAreClosedAndRobotMeshesLoad) {
  const fs::path shared = OPPONENS_SHARED_DATA;
  if (!fs::exists(shared / "data/objects/ycb")) GTEST_SKIP() << shared << " is absent";
  int count = 0;
  for (const auto& folder : fs::directory_iterator(shared / "data/objects/ycb")) {
    const auto mesh = load_mesh(folder.path() / (folder.path().filename().string() + ".obj"));
    EXPECT_TRUE(is_closed(*mesh)) << folder.path();
    EXPECT_EQ(component_seeds(*mesh).size(), 1U) << folder.path();
    EXPECT_GE(mesh->triangles.cols(), 16382) << folder.path();
    const double volume = mass_properties(*mesh).volume;
    EXPECT_TRUE(volume > 1e-5 && volume < 1e-2) << folder.path() << " " << volume;
    ++count;
  }
  EXPECT_EQ(count, 10);
  // The same link as DAE (z up, left as written) and as a coarse STL.
  const fs::path ur5 = shared / "data/robots/example-robot-data/robots/ur_description/meshes/ur5";
  const auto fine = load_mesh(ur5 / "visual/upperarm.dae");
  const auto coarse = load_mesh(ur5 / "collision/upperarm.stl");
  EXPECT_LT((fine->vertices.rowwise().maxCoeff() - coarse->vertices.rowwise().maxCoeff()).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((fine->vertices.rowwise().minCoeff() - coarse->vertices.rowwise().minCoeff()).cwiseAbs().maxCoeff(), 1e-3);
  const auto palm = load_mesh(shared / "data/robots/paper_lab_ur5_allegro/meshes/AllegroHand_right_base_link_right.stl",
                              Eigen::Vector3d::Constant(0.001));
  EXPECT_NEAR(mass_properties(*palm).volume, 1.468e-4, 1e-6);
}

}  // namespace
}  // namespace opponens::robot
