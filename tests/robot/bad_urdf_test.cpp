// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Files that would crash, hang, or read what they should not: one line, quickly.
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "robot_files.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

class BadUrdf : public RobotFiles {
 protected:
  std::string with_mesh(const std::string& filename, const std::string& packages = "") const {
    write("hand.urdf", robot("<link name='a'><collision><geometry><mesh filename='" + filename +
                             "'/></geometry></collision></link>" + links("b") + joint("j", "a", "b")));
    return error_of(write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n" + packages));
  }

  /// A text STL of one triangle.
  void write_stl(const fs::path& file) const {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                           "endloop\nendfacet\nendsolid t\n";
  }
};

TEST_F(BadUrdf, MeshPathsStayInTheirPackage) {
  const std::string packages = "packages: {x: pack}\n";
  write_stl(folder_ / "pack/meshes/t.stl");
  write_stl(folder_ / "secret/t.stl");
  EXPECT_EQ(with_mesh("package://x/meshes/t.stl", packages), "no error");
  EXPECT_EQ(with_mesh("package://x/meshes/../meshes/t.stl", packages), "no error");
  for (const char* path : {"package://x/../secret/t.stl", "package://x/meshes/../../secret/t.stl", "package://../t.stl",
                           "package://x//etc/passwd", "package:///etc/t.stl", "package://x/../../../../etc/t.stl"}) {
    expect_contains(with_mesh(path, packages), {"hand.urdf", "'a'", path, "leaves its package"});
  }
  // A link inside the package that stays in it is followed, one that leads out is not.
  fs::create_directory_symlink(folder_ / "pack/meshes", folder_ / "pack/same");
  fs::create_directory_symlink(folder_ / "secret", folder_ / "pack/out");
  fs::create_directory_symlink(folder_ / "pack", folder_ / "alias");
  EXPECT_EQ(with_mesh("package://x/same/t.stl", packages), "no error");
  EXPECT_EQ(with_mesh("package://x/meshes/t.stl", "packages: {x: alias}\n"), "no error");
  expect_contains(with_mesh("package://x/out/t.stl", packages), {"hand.urdf", "'a'", "leaves its package"});
  fs::create_symlink("circle.stl", folder_ / "pack/circle.stl");
  expect_contains(with_mesh("package://x/circle.stl", packages), {"hand.urdf", "'a'", "circle.stl"});
  expect_contains(with_mesh("package://x/" + std::string(5000, 'a') + ".stl", packages), {"hand.urdf", "'a'"});
}

TEST_F(BadUrdf, PackagesAreFoundAboveTheUrdf) {
  write_stl(folder_ / "my_robot/meshes/t.stl");
  write_stl(folder_ / "beside/meshes/t.stl");
  fs::create_directories(folder_ / "my_robot/urdf");
  const auto load = [&](const std::string& mesh) {
    write("my_robot/urdf/hand.urdf", robot("<link name='a'><collision><geometry><mesh filename='" + mesh +
                                           "'/></geometry></collision></link>" + links("b") + joint("j", "a", "b")));
    return load_hand(write("hand.yaml", "urdf: my_robot/urdf/hand.urdf\npalm_link: a\njoints: [j]\n"));
  };
  EXPECT_EQ(load("package://my_robot/meshes/t.stl").links[0].collision.size(), 1u);
  EXPECT_EQ(load("package://beside/meshes/t.stl").links[0].collision.size(), 1u);
  EXPECT_THROW(load("package://nowhere/meshes/t.stl"), InputError);
}

TEST_F(BadUrdf, MeshesThatAreNone) {
  fs::create_directory(folder_ / "folder.stl");
  expect_contains(with_mesh("folder.stl"), {"hand.urdf", "'a'", "folder.stl", "is a directory"});
  expect_contains(with_mesh("/dev/zero"), {"hand.urdf", "'a'", "/dev/zero", "not a regular file"});
  EXPECT_EQ(with_mesh(""), "no error") << "as SolidWorks exports links without a shape: noted";
  // A binary STL whose header announces 20 million triangles, 1 GB, and ends there.
  std::string stl(84, '\0');
  const std::uint32_t count = 20'000'000;
  std::memcpy(stl.data() + 80, &count, sizeof(count));
  write("large.stl", stl);
  expect_contains(with_mesh("large.stl"), {"hand.urdf", "'a'", "large.stl", "announces 20000000 triangles"});
  write("large.obj", "v 0 0 0\nf 1 2000000000 3\n");
  expect_contains(with_mesh("large.obj"), {"large.obj"});
  write("large.dae",
        "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><library_geometries><geometry "
        "id='g'><mesh><source id='s'><float_array id='f' count='4000000000'>0 0</float_array></source></mesh>"
        "</geometry></library_geometries></COLLADA>");
  expect_contains(with_mesh("large.dae"), {"large.dae"});
  write("empty.dae", "");
  expect_contains(with_mesh("empty.dae"), {"empty.dae"});
  write("text.stl", "solid");
  expect_contains(with_mesh("text.stl"), {"text.stl"});
}

TEST_F(BadUrdf, MeshScalesAreFiniteAndNotZero) {
  write_stl(folder_ / "t.stl");
  const auto scaled = [&](const std::string& scale) { return with_mesh("t.stl' scale='" + scale); };
  EXPECT_EQ(scaled("-1 1 1"), "no error");
  EXPECT_EQ(scaled("1e-150 1e-150 1e-150"), "no error") << "the product vanishes, the mesh does not";
  for (const char* scale : {"1 0 1", "inf 1 1", "1 nan 1"}) {
    expect_contains(scaled(scale), {"hand.urdf", "'a'", "scale"});
  }
  write("far.obj", "v 0 0 0\nv 1e10 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_contains(with_mesh("far.obj' scale='1e300 1 1"), {"hand.urdf", "'a'", "far.obj", "not finite once scaled"});
}

TEST_F(BadUrdf, ANegativeMeshScaleMirrorsTheSolid) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  for (const std::string scale : {"1 -1 1", "-1 -1 -1", "1e-120 -1e-120 1e-120"}) {
    write("hand.urdf", robot("<link name='a'><collision><geometry><mesh filename='t.obj' scale='" + scale +
                             "'/></geometry></collision></link>" + links("b") + joint("j", "a", "b")));
    const auto hand = load_hand(write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n"));
    TriangleMesh mesh = *std::get<std::shared_ptr<const TriangleMesh>>(hand.links[0].collision[0].shape);
    EXPECT_LT(mesh.vertices.row(1).minCoeff(), 0.0) << scale;
    EXPECT_EQ(mesh.vertices.row(1).maxCoeff(), 0.0) << scale;
    mesh.vertices /= mesh.vertices.cwiseAbs().maxCoeff();
    EXPECT_NEAR(mass_properties(mesh).volume, 1.0 / 6.0, 1e-6) << scale << ": the surface is inside out";
  }
}

TEST_F(BadUrdf, NestingDoesNotExhaustTheStack) {
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 300000; ++i) deep += "<a>";
  expect_contains(urdf_error(deep), {"hand.urdf", "line 1", "inside each other"});
  std::string hidden = "<robot name='r'>";
  for (int i = 0; i < 300000; ++i) hidden += "<a b='/>'><!-- </a> -->";
  expect_contains(urdf_error(hidden), {"hand.urdf", "line 1", "inside each other"});
  const std::string commented = "<!--" + std::string(1000, '<') + "-->";
  EXPECT_EQ(urdf_error(robot(commented + links("ab") + joint("j", "a", "b"))), "no error");
}

TEST_F(BadUrdf, MoreJointsThanAnyRobot) {
  std::string chain = "<link name='l0'/>";
  for (int i = 1; i <= 2100; ++i) {
    const std::string before = std::to_string(i - 1);
    const std::string n = std::to_string(i);
    chain += "<link name='l" + n + "'/>" + joint("j" + n, "l" + before, "l" + n);
  }
  expect_contains(urdf_error(robot(chain)), {"hand.urdf", "more than 2000 joints"});
}

TEST_F(BadUrdf, ElementsThatContradictThemselves) {
  expect_contains(urdf_error(robot(links("aab") + joint("j", "a", "b"))), {"hand.urdf", "'a'"});
  expect_contains(urdf_error(robot(links("abc") + joint("j", "a", "b") + joint("j", "b", "c"))), {"hand.urdf", "'j'"});
  expect_contains(urdf_error(robot(links("abc") + joint("j", "a", "b", "revolute", kLimit + "<mimic joint='k'/>") +
                                   joint("k", "b", "c", "revolute", kLimit + "<mimic joint='j'/>"))),
                  {"hand.urdf", "'j'", "mimics itself"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<mimic joint='j'/>"))),
                  {"hand.urdf", "'j'", "mimics itself"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<mimic/>"))),
                  {"hand.urdf"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "a"))), {"hand.urdf"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "z"))), {"hand.urdf", "z"});
  expect_contains(urdf_error(robot("<link/>" + links("ab") + joint("j", "a", "b"))), {"hand.urdf", "link"});
  expect_contains(urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<axis xyz='1 0'/>"))),
                  {"hand.urdf", "j"});
  expect_contains(
      urdf_error(robot(links("ab") + joint("j", "a", "b", "revolute", kLimit + "<origin xyz='inf 0 0' rpy='0 0 0'/>"))),
      {"hand.urdf", "j"});
  expect_contains(
      urdf_error(robot("<link name='a'><collision><origin xyz='nan 0 0'/><geometry><box size='1 1 1'/></geometry>"
                       "</collision></link>" +
                       links("b") + joint("j", "a", "b"))),
      {"hand.urdf", "a"});
  expect_contains(urdf_error(robot("")), {"hand.urdf"});
  expect_contains(urdf_error(std::string(1, '\0')), {"hand.urdf"});
}

TEST_F(BadUrdf, ShapesThatNobodyUnderstandsAreNoted) {
  write("hand.urdf", robot("<link name='a'><collision><geometry><capsule radius='1' length='2'/></geometry></collision>"
                           "<collision><geometry><sphere radius='1'/></geometry></collision><visual/></link>" +
                           links("b") + joint("j", "a", "b")));
  const RobotDescription loaded = load_hand(write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n"));
  EXPECT_EQ(loaded.links[0].collision.size(), 1u);
  ASSERT_EQ(loaded.notes.size(), 2u);
  expect_contains(loaded.notes[0], {"hand.urdf", "link 'a'", "<visual> in line 1", "is left out"});
  expect_contains(loaded.notes[1], {"hand.urdf", "link 'a'", "<collision> in line 1", "is left out"});
}

TEST_F(BadUrdf, MissingMeshesAreListedWhereAsked) {
  write("hand.urdf", robot("<link name='a'><collision><geometry><mesh filename='one.stl'/></geometry></collision>"
                           "<collision><geometry><sphere radius='1'/></geometry></collision></link>"
                           "<link name='b'><collision><geometry><mesh filename='package://p/two.stl'/></geometry>"
                           "</collision></link>" +
                           joint("j", "a", "b")));
  const auto yaml = write("hand.yaml", "urdf: hand.urdf\npalm_link: a\njoints: [j]\n");
  expect_contains(error_of(yaml), {"hand.urdf", "'a'", "one.stl"});
  const RobotDescription loaded = load_hand(yaml, MissingMeshes::list);
  ASSERT_EQ(loaded.missing_meshes.size(), 2u);
  EXPECT_EQ(loaded.missing_meshes[0].link, "a");
  EXPECT_EQ(loaded.missing_meshes[0].mesh, "one.stl");
  EXPECT_EQ(loaded.missing_meshes[1].mesh, "package://p/two.stl");
  EXPECT_NE(loaded.missing_meshes[1].reason.find("'p'"), std::string::npos);
  EXPECT_EQ(loaded.links[0].collision.size(), 1u) << "the sphere stays";
}

}  // namespace
}  // namespace opponens::robot
