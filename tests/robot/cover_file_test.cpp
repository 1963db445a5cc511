// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover_file.hpp"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot/mesh.hpp"
#include "robot/narrow_phase.hpp"
#include "robot/solid_region.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

using Mesh = std::shared_ptr<const TriangleMesh>;

Mesh box_mesh(double length) { return std::make_shared<const TriangleMesh>(triangulate(Box{{0.1, 0.2, length}})); }

Mesh cylinder_mesh() { return std::make_shared<const TriangleMesh>(triangulate(Cylinder{0.05, 0.3}, 48)); }

/// A scene whose only body is a mesh.
Scene scene_of(const std::vector<Mesh>& meshes) {
  Scene scene;
  for (const Mesh& mesh : meshes) scene.bodies.push_back({"body", Eigen::Isometry3d::Identity(), {{mesh}}});
  return scene;
}

Mesh mesh_of(const Scene& scene, std::size_t body = 0) { return std::get<Mesh>(scene.bodies[body].geometry[0].shape); }

MeshCover cover_of(const Mesh& mesh, const fs::path& folder) {
  return *mesh_of(with_covers(scene_of({mesh}), folder))->cover.get();
}

void expect_equal(const HullVertices& a, const HullVertices& b) {
  EXPECT_EQ(a.all.count, b.all.count);
  EXPECT_EQ(a.all.xyz, b.all.xyz);
  EXPECT_EQ(a.few.count, b.few.count);
  EXPECT_EQ(a.few.xyz, b.few.xyz);
  EXPECT_EQ(a.rounding, b.rounding);
}

/// To the last bit.
void expect_equal(const MeshCover& a, const MeshCover& b) {
  ASSERT_EQ(a.tree.nodes.size(), b.tree.nodes.size());
  for (std::size_t i = 0; i < a.tree.nodes.size(); ++i) {
    const SphereTree::Node& x = a.tree.nodes[i];
    const SphereTree::Node& y = b.tree.nodes[i];
    EXPECT_TRUE(x.center == y.center && x.radius == y.radius && x.first_child == y.first_child &&
                x.children == y.children)
        << "node " << i;
  }
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  for (std::size_t i = 0; i < a.pieces.size(); ++i) expect_equal(a.pieces[i], b.pieces[i]);
  expect_equal(a.hull, b.hull);
}

class CoverFile : public testing::Test {
 protected:
  CoverFile() { fs::create_directories(folder_.parent_path()); }
  ~CoverFile() override {
    std::error_code error;
    fs::permissions(folder_, fs::perms::owner_all, error);
    fs::remove_all(folder_.parent_path(), error);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path());
    return found;
  }
  static std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  }

  const testing::TestInfo& info_ = *testing::UnitTest::GetInstance()->current_test_info();
  fs::path folder_ =
      fs::path(testing::TempDir()) / ("cover_file." + std::to_string(::getpid()) + "." + info_.name()) / "covers";
};

TEST_F(CoverFile, ReadsWhatItWroteToTheLastBit) {
  const Mesh mesh = cylinder_mesh();
  const MeshCover fresh = mesh_cover(*mesh);
  ASSERT_GT(fresh.tree.nodes.size(), 40U);
  expect_equal(cover_of(mesh, folder_), fresh);  // makes the folder as well
  ASSERT_EQ(files().size(), 1U);
  // The content decides: the next one is read, although its file is older than the mesh.
  const fs::file_time_type written = fs::last_write_time(files()[0]);
  expect_equal(cover_of(cylinder_mesh(), folder_), fresh);
  EXPECT_EQ(fs::last_write_time(files()[0]), written);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(CoverFile, IsWhatTheCheckerMakesItself) {
  const Mesh mesh = cylinder_mesh();
  const CollisionShape plain(mesh);
  const CollisionShape covered(mesh_of(with_covers(scene_of({mesh}), folder_)));
  expect_equal({plain.cover(), plain.pieces(), plain.hull()}, {covered.cover(), covered.pieces(), covered.hull()});
}

/// The file is read indeed: one that was altered and given the right sum gives another cover, and the checker uses it.
TEST_F(CoverFile, TheFileIsWhatIsUsed) {
  const Mesh mesh = box_mesh(0.3);
  const MeshCover fresh = cover_of(mesh, folder_);
  const fs::path file = files().at(0);
  std::string bytes = read(file);
  const double radius = fresh.tree.nodes[0].radius;
  const std::size_t place = bytes.find(std::string(reinterpret_cast<const char*>(&radius), sizeof(radius)));
  ASSERT_NE(place, std::string::npos);
  const double larger = 2.0 * radius;
  std::memcpy(bytes.data() + place, &larger, sizeof(larger));
  constexpr std::size_t kSum = 32;
  EVP_Digest(bytes.data(), bytes.size() - kSum, reinterpret_cast<unsigned char*>(bytes.data()) + bytes.size() - kSum,
             nullptr, EVP_sha256(), nullptr);
  write(file, bytes);
  const Mesh covered = mesh_of(with_covers(scene_of({mesh}), folder_));
  EXPECT_EQ(CollisionShape(covered).cover().nodes[0].radius, larger);
  // A mesh that has a cover keeps it.
  EXPECT_EQ(mesh_of(with_covers(scene_of({covered}), folder_)), covered);
}

TEST_F(CoverFile, MeshesThatDifferDoNotShare) {
  const Mesh mesh = box_mesh(0.3);
  auto moved = std::make_shared<TriangleMesh>(*mesh);
  moved->vertices(0, 0) = std::nextafter(moved->vertices(0, 0), 1.0);
  auto turned = std::make_shared<TriangleMesh>(*mesh);
  turned->triangles.col(0).reverseInPlace();
  for (const Mesh& one : {mesh, Mesh(moved), Mesh(turned)}) expect_equal(cover_of(one, folder_), mesh_cover(*one));
  EXPECT_EQ(files().size(), 3U);
  // The file of another mesh under this one's name.
  std::vector<fs::path> all = files();
  for (const fs::path& file : all) {
    if (file != all[0]) fs::copy_file(all[0], file, fs::copy_options::overwrite_existing);
  }
  for (const Mesh& one : {mesh, Mesh(moved), Mesh(turned)}) expect_equal(cover_of(one, folder_), mesh_cover(*one));
}

TEST_F(CoverFile, AMeshOfSeveralLinksStaysOne) {
  const Mesh mesh = box_mesh(0.3);
  RobotDescription robot;
  robot.links.resize(3);
  for (Link& link : robot.links) link.collision = {{mesh}, {Sphere{0.1}}};
  const RobotDescription covered = with_covers(robot, folder_);
  EXPECT_EQ(std::get<Mesh>(covered.links[0].collision[0].shape), std::get<Mesh>(covered.links[2].collision[0].shape));
  EXPECT_EQ(std::get<Sphere>(covered.links[1].collision[1].shape).radius, 0.1);
  EXPECT_EQ(mesh->cover.get(), nullptr);
}

TEST_F(CoverFile, EveryDamageCountsAsAbsentAndIsMended) {
  const Mesh mesh = box_mesh(0.05);
  const MeshCover fresh = cover_of(mesh, folder_);
  const fs::path file = files().at(0);
  const std::string good = read(file);
  Rng rng = stream(1, "cover damage");
  std::vector<std::string> bad{"", good + "x", std::string(good.size(), '\0'), good + good};
  for (std::size_t size = 0; size < good.size(); size += 61) bad.push_back(good.substr(0, size));
  for (std::size_t i = 0; i < good.size(); i += 1 + i / 40) {  // every byte of the header, then fewer and fewer
    bad.push_back(good);
    bad.back()[i] = static_cast<char>(bad.back()[i] ^ (1 << rng() % 8));
  }
  for (const std::string& bytes : bad) {
    write(file, bytes);
    expect_equal(cover_of(mesh, folder_), fresh);
    ASSERT_EQ(read(file), good);
  }
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(CoverFile, FoldersThatCannotBeUsed) {
  const Mesh mesh = box_mesh(0.3);
  const MeshCover fresh = mesh_cover(*mesh);
  expect_equal(cover_of(mesh, {}), fresh);
  expect_equal(cover_of(mesh, "/proc/no such/folder"), fresh);
  const fs::path plain_file = folder_.parent_path() / "plain";
  write(plain_file, "text");
  expect_equal(cover_of(mesh, plain_file), fresh);
  expect_equal(cover_of(mesh, plain_file / "below"), fresh);
  EXPECT_EQ(read(plain_file), "text");
  // A folder in place of the file.
  cover_of(mesh, folder_);
  const fs::path file = files().at(0);
  fs::remove(file);
  fs::create_directories(file / "inside");
  expect_equal(cover_of(mesh, folder_), fresh);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(CoverFile, AReadOnlyFolderAnswersAndStaysAsItIs) {
  const Mesh known = box_mesh(0.3);
  cover_of(known, folder_);
  constexpr fs::perms kReadOnly = fs::perms::owner_read | fs::perms::owner_exec;
  fs::permissions(folder_, kReadOnly | fs::perms::others_read | fs::perms::others_exec);
  const bool root = ::geteuid() == 0;  // root may write everywhere
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(root ? ::seteuid(kNobody) : 0, 0);
  EXPECT_FALSE(std::ofstream(folder_ / "trial").is_open());
  for (const Mesh& mesh : {known, box_mesh(0.2)}) expect_equal(cover_of(mesh, folder_), mesh_cover(*mesh));
  ASSERT_EQ(root ? ::seteuid(0) : 0, 0);
  EXPECT_EQ(files().size(), 1U);
}

/// Processes that write, read and delete the same files at once: each gets what it would have made itself.
TEST_F(CoverFile, ManyProcessesAndDeletionsAtOnce) {
  const std::vector<Mesh> meshes{box_mesh(0.03), box_mesh(0.04), box_mesh(0.05)};
  std::vector<MeshCover> fresh;
  for (const Mesh& mesh : meshes) fresh.push_back(mesh_cover(*mesh));
  std::vector<pid_t> children;
  for (unsigned child = 0; child < 4; ++child) {
    const pid_t id = ::fork();
    ASSERT_GE(id, 0);
    if (id == 0) {
      for (unsigned round = 0; round < 60; ++round) {
        std::error_code error;
        if (child == 0 && round % 5 == 0) fs::remove_all(folder_, error);
        const std::size_t k = (child + round) % meshes.size();
        expect_equal(cover_of(meshes[k], folder_), fresh[k]);
      }
      ::_exit(HasFailure() ? 1 : 0);
    }
    children.push_back(id);
  }
  for (const pid_t id : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(id, &status, 0), id);
    EXPECT_EQ(status, 0);
  }
  for (std::size_t k = 0; k < meshes.size(); ++k) expect_equal(cover_of(meshes[k], folder_), fresh[k]);
  for (const fs::path& file : files()) EXPECT_EQ(file.extension(), ".cover") << "left over";
}

/// When this fails, mesh_cover or the layout has changed: raise kVersion in cover_file.cpp, lest old files be
/// used, and put the new name and sum here. Version 2: with convex pieces. A box needs no functions of the C library
/// that may differ between machines.
TEST_F(CoverFile, KeepsItsVersion) {
  cover_of(box_mesh(0.3), folder_);
  const fs::path file = files().at(0);
  const std::string bytes = read(file);
  std::uint64_t sum = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
  EXPECT_EQ(file.filename().string(), "251123faff8365b69f507b8407cc16e74c5daf68cfd657f605e4b5f00f86d46c.cover");
  EXPECT_EQ(sum, 17623532134217771240ULL);
}

/// What covers promise: points of the solid lie in a ball of every level.
TEST(SphereTreeCover, LeavesContainTheSolid) {
  Rng rng = stream(1, "cover points");
  TriangleMesh two = triangulate(Box{{0.1, 0.3, 0.05}});
  const TriangleMesh other = triangulate(Cylinder{0.06, 0.2}, 24);
  two = merge({{std::make_shared<const TriangleMesh>(two)},
               {std::make_shared<const TriangleMesh>(other), at(0.02, 0.1, 0.03)}});
  for (const TriangleMesh& mesh : {two, triangulate(Sphere{0.1}), triangulate(Cylinder{0.02, 0.5}, 12)}) {
    const SolidRegion region(mesh);
    const SphereTree tree = mesh_cover(mesh).tree;
    const Eigen::AlignedBox3d box(mesh.vertices.rowwise().minCoeff(), mesh.vertices.rowwise().maxCoeff());
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
      Eigen::Vector3d p = box.min();
      for (int k = 0; k < 3; ++k) p[k] += rng.uniform(0.0, box.sizes()[k]);
      if (!region.contains(p)) continue;
      ++inside;
      EXPECT_LE((p - tree.nodes[0].center).norm(), tree.nodes[0].radius);
      std::vector<int> level{0};
      bool leaf = false;
      for (std::size_t n = 0; n < level.size() && !leaf; ++n) {
        const SphereTree::Node& node = tree.nodes[static_cast<std::size_t>(level[n])];
        if ((p - node.center).norm() > node.radius) continue;
        leaf = node.children == 0;
        for (int c = 0; c < node.children; ++c) level.push_back(node.first_child + c);
      }
      EXPECT_TRUE(leaf) << p.transpose();
    }
    EXPECT_GT(inside, 1000);
  }
}

/// Who copies, moves or assigns a mesh may change it afterwards, so that the cover would be of another one.
TEST_F(CoverFile, StaysWithTheMeshItWasMadeOf) {
  const Mesh mesh = mesh_of(with_covers(scene_of({box_mesh(0.3)}), folder_));
  ASSERT_NE(mesh->cover.get(), nullptr);
  EXPECT_EQ(triangulate(mesh).cover.get(), nullptr);
  const auto kept = std::make_shared<const MeshCover>(*mesh->cover.get());
  const TriangleMesh plain = *mesh;
  EXPECT_EQ(plain.cover.get(), nullptr);
  TriangleMesh one = plain;
  one.cover.keep(kept);
  ASSERT_EQ(one.cover.get(), kept.get());
  one = plain;
  EXPECT_EQ(one.cover.get(), nullptr);
  one.cover.keep(kept);
  TriangleMesh moved = std::move(one);
  EXPECT_EQ(moved.cover.get(), nullptr);
  EXPECT_EQ(one.cover.get(), nullptr);  // NOLINT: what is left of it has no triangles
  one = plain;
  one.cover.keep(kept);
  moved.cover.keep(kept);
  moved = std::move(one);
  EXPECT_EQ(moved.cover.get(), nullptr);
  EXPECT_EQ(one.cover.get(), nullptr);  // NOLINT
}

}  // namespace
}  // namespace opponens::robot
