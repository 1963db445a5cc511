// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/scene.hpp"

#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/require.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

class SceneFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("opponens_scene_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text, const std::string& name = "scene.yaml") const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  std::string error_of(const std::string& text) const {
    try {
      load_scene(write(text));
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "accepted:\n" << text;
    return {};
  }

  fs::path folder_;
};

TEST_F(SceneFiles, ReadsEveryField) {
  write("v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", "t.obj");
  ASSERT_EQ(setenv("OPPONENS_TEST_FOLDER", folder_.c_str(), 1), 0);
  const Scene scene = load_scene(write(R"(name: all
robot_base: {xyz: [1, 2, 3], rpy: [0, 0, 1.5707963267948966]}
object: thing
support: board
start: {b: 0.5, a: -1}
bodies:
  - name: thing
    pose: {xyz: [0, 0, 1], quaternion: [0.70710678, 0, 0, 0.70710678]}
    geometry:
      - {box: {size: [1, 2, 3]}, pose: {xyz: [4, 0, 0]}}
      - {sphere: {radius: 0.5}}
      - {cylinder: {radius: 0.5, length: 2}}
      - {mesh: {file: t.obj, unit: mm}}
      - {mesh: {file: "${OPPONENS_TEST_FOLDER}/t.obj", unit: mm, scale: [2, 1, 1]}}
      - {revolution: {profile: [[0.1, 0], [0.1, 1]], segments: 8}}
  - name: board
    geometry: [{mesh: {file: t.obj, unit: mm}}]
)"));
  EXPECT_EQ(scene.name, "all");
  EXPECT_EQ(scene.object, "thing");
  EXPECT_EQ(scene.support, "board");
  EXPECT_TRUE((scene.X_WR * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
  EXPECT_EQ(scene.start_joints, (std::vector<std::string>{"b", "a"}));
  EXPECT_TRUE(scene.start.isApprox(Eigen::Vector2d(0.5, -1)));
  const SceneBody& thing = scene.body("thing");
  ASSERT_EQ(thing.geometry.size(), 6U);
  EXPECT_TRUE((thing.X_WB * thing.geometry[0].X_BG.translation()).isApprox(Eigen::Vector3d(0, 4, 1), 1e-7));
  EXPECT_EQ(std::get<Box>(thing.geometry[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<Sphere>(thing.geometry[1].shape).radius, 0.5);
  EXPECT_EQ(std::get<Cylinder>(thing.geometry[2].shape).length, 2.0);
  using MeshPointer = std::shared_ptr<const TriangleMesh>;
  EXPECT_NEAR(mass_properties(*std::get<MeshPointer>(thing.geometry[3].shape)).volume, 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(mass_properties(*std::get<MeshPointer>(thing.geometry[4].shape)).volume, 2.0 / 6.0, 1e-12);
  EXPECT_EQ(std::get<MeshPointer>(thing.geometry[5].shape)->triangles.cols(), 32);
  // Equal meshes are read once and shared.
  EXPECT_EQ(std::get<MeshPointer>(thing.geometry[3].shape),
            std::get<MeshPointer>(scene.body("board").geometry[0].shape));
  EXPECT_THROW(scene.body("absent"), std::invalid_argument);
}

TEST_F(SceneFiles, EveryMistakeNamesLineFieldAndExpectation) {
  const std::string head = "name: s\nbodies:\n  - name: a\n    geometry:\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"bodies: []\n", "'name'"},
      {"name: s\n", "'bodies'"},
      {"name: s\nbodies: 3\n", ":2: bodies: expected a list"},
      {"name: [\n", "not YAML"},
      {"name: s\nbodies: []\nobjct: a\n", ":3: objct: unknown key"},
      {"name: s\nname: t\nbodies: []\n", "occurs twice"},
      {"name: s\nbodies: []\nobject: cup\n", ":3: object: 'cup' is not a body"},
      {"name: s\nbodies: []\nsupport: cup\n", "support: 'cup'"},
      {"name: s\nbodies: []\nstart: {a: 1, b: .nan}\n", ":3: start.b: expected a finite number, found '.nan'"},
      {"name: s\nbodies: []\nstart: {a: 1, a: 2}\n", "occurs twice"},
      {"name: s\nbodies: []\nrobot_base: {xyz: [0, 0]}\n", ":3: robot_base.xyz: expected 3 numbers, found 2"},
      {"name: s\nbodies: []\nrobot_base: {rpy: [0, 0, x]}\n", "robot_base.rpy[2]: expected a number, found 'x'"},
      {"name: s\nbodies: []\nrobot_base: {quaternion: [1, 1, 0, 0]}\n", "unit quaternion"},
      {"name: s\nbodies: []\nrobot_base: {quaternion: [1, 0, 0, 0], rpy: [0, 0, 0]}\n", "both rpy and quaternion"},
      {head + "      - {}\n", "exactly one of box"},
      {head + "      - {box: {size: [1, 1, 1]}, sphere: {radius: 1}}\n", "found 2"},
      {head + "      - {box: {size: [1, -1, 1]}}\n", ":5: bodies[0].geometry[0].box.size: expected three positive"},
      {head + "      - {sphere: {radius: 0}}\n", "radius: expected a positive number, found '0'"},
      {head + "      - {cylinder: {radius: 1}}\n", "'length'"},
      {head + "      - {cone: {radius: 1}}\n", "cone: unknown key"},
      {head + "      - {mesh: {file: absent.stl}}\n", "absent.stl: no such file"},
      {head + "      - {mesh: {file: \"${OPPONENS_NOT_SET_ANYWHERE}/a.stl\"}}\n",
       "OPPONENS_NOT_SET_ANYWHERE is not set"},
      {head + "      - {mesh: {file: a.stl, unit: inch}}\n", "expected m, cm, mm or in, found 'inch'"},
      {head + "      - {mesh: {file: a.stl, scale: 0}}\n", "scale: expected a positive factor"},
      {head + "      - {mesh: {file: a.stl, scale: [1, -1, 1]}}\n", "scale: expected a positive factor"},
      {head + "      - {mesh: {file: a.stl, unit: mm, scale: 1e-323}}\n", "scale: leaves nothing of the mesh"},
      {head + "      - {revolution: {profile: [[0.1, 0], [0.1, -1]]}}\n", "does not rise"},
      {head + "      - {revolution: {profile: [[0.1, 0], [0.1, 1]], segments: 2.5}}\n", "whole number from 3"},
      {"name: s\nbodies:\n  - {name: a, geometry: []}\n", "'a' needs at least one shape"},
      {"name: s\nbodies:\n  - {name: a, geometry: [{sphere: {radius: 1}}]}\n  - {name: a, geometry: [{sphere: {radius: "
       "1}}]}\n",
       ":4: bodies[1].name: there are two bodies 'a'"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = error_of(text);
    EXPECT_NE(message.find(expected), std::string::npos) << "expected: " << expected << "\nmessage:  " << message;
    EXPECT_NE(message.find("scene.yaml"), std::string::npos) << message;
  }
  EXPECT_THROW(load_scene(folder_ / "none.yaml"), InputError);
  EXPECT_THROW(load_scene(folder_), InputError);
}

/// The scenes that come with the program, with the robot that comes with it.
class OwnScenes : public testing::TestWithParam<const char*> {};

TEST_P(OwnScenes, StartsFreeWithTheObjectOnItsSupport) {
  const fs::path models = fs::path(OPPONENS_SOURCE_DIR) / "models";
  const Scene scene = load_scene(models / "scenes" / GetParam());
  const RobotModel robot(load_robot(models / "ur5_allegro/ur5_allegro_right.yaml"));
  ASSERT_EQ(static_cast<int>(scene.start_joints.size()), robot.dof());
  Eigen::VectorXd start(robot.dof());
  for (int i = 0; i < robot.dof(); ++i) {
    const auto& names = scene.start_joints;
    const auto found = std::find(names.begin(), names.end(), robot.joint_names()[static_cast<std::size_t>(i)]);
    ASSERT_NE(found, names.end());
    start[i] = scene.start[found - names.begin()];
  }
  EXPECT_TRUE(robot.within_limits(start));
  const CollisionChecker checker(robot, scene);
  EXPECT_TRUE(checker.open_meshes().empty());
  EXPECT_TRUE(checker.free(start));
  // Away from everything in the scene, the palm at least 10 cm.
  const SceneBody& object = scene.body(scene.object);
  const SceneBody& support = scene.body(scene.support);
  const Eigen::Vector3d palm =
      (scene.X_WR * robot.link_poses(start)[static_cast<std::size_t>(robot.palm())]).translation();
  EXPECT_GT((palm - object.X_WB.translation()).norm(), 0.2);
  // The object's lowest point lies on the support's top.
  const auto extent = [](const SceneBody& body) {
    const TriangleMesh mesh = merge(body.geometry);
    const Eigen::Matrix3Xd v = (body.X_WB.linear() * mesh.vertices).colwise() + body.X_WB.translation();
    return std::pair<double, double>(v.row(2).minCoeff(), v.row(2).maxCoeff());
  };
  EXPECT_NEAR(extent(object).first, extent(support).second, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Committed, OwnScenes,
                         testing::Values("bottle_shelf.yaml", "bottle_shelf_hard.yaml", "cylinder_shelf.yaml",
                                         "cylinder_shelf_hard.yaml", "box_table.yaml", "box_table_hard.yaml"));

}  // namespace
}  // namespace opponens::robot
