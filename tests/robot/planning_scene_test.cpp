// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "foreign_scenes.hpp"
#include "robot/mesh.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;
using MeshPointer = std::shared_ptr<const TriangleMesh>;

const char* const kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const char* const kPlanningScene = R"(name: ""
robot_model_name: arm
robot_state:
  joint_state: {name: [a, b], position: [0.5, -1]}
fixed_frame_transforms:
  - {child_frame_id: world, transform: {rotation: [0, 0, 0, 1], translation: [0, 0, 0]}}
  - child_frame_id: shelf_frame
    transform: {rotation: {x: 0, y: 0, z: 0.70710678, w: 0.70710678}, translation: {x: 0, y: 0, z: 2}}
allowed_collision_matrix:
  entry_names: [p, q]
  entry_values: [[false, true], [true, false]]
world:
  collision_objects:
    - id: lists
      primitives: [{type: box, dimensions: [1, 2, 3]}, {type: cylinder, dimensions: [0.4, 0.1]}]
      primitive_poses:
        - {position: [1, 0, 0], orientation: [0, 0, 0, 1]}
        - {position: [0, 1, 0], orientation: [1, 0, 0, 0]}
      subframe_names: [tip]
    - id: maps
      header: {frame_id: shelf_frame}
      pose: {position: {x: 1, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0.70710678, w: 0.70710678}}
      primitives: [{type: sphere, dimensions: [0.25]}, {type: "4", dimensions: [0.3, 0.1]}]
      primitive_poses:
        - {position: {x: 1, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0, w: 1}}
        - {position: [0, 0, 0], orientation: [0, 0, 0, 1]}
    - id: meshes
      header: {frame_id: world}
      meshes:
        - {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], triangles: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]}
        - {resource: t.obj, dimensions: [2, 1, 1]}
        - vertices: [{x: 0, y: 0, z: 0}, {x: 1, y: 0, z: 0}, {x: 0, y: 1, z: 0}, {x: 0, y: 0, z: 1}]
          triangles: [{vertex_indices: [0, 2, 1]}, {vertex_indices: [0, 1, 3]}, {vertex_indices: [0, 3, 2]},
                      {vertex_indices: [1, 2, 3]}]
      mesh_poses:
        - {position: [0, 0, 0], orientation: [0, 0, 0, 1]}
        - {position: [0, 0, 0], orientation: [0, 0, 0, 1]}
        - {position: [0, 0, 5], orientation: [0, 0.707, 0, 0.707]}
)";

TEST_F(ForeignScenes, ReadsAPlanningScene) {
  write(kTetrahedron, "t.obj");
  const Scene scene = load_scene(write(kPlanningScene, "moveit.yaml"));
  EXPECT_EQ(scene.name, "moveit");
  EXPECT_EQ(scene.start_joints, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(scene.start.isApprox(Eigen::Vector2d(0.5, -1)));
  EXPECT_TRUE(scene.X_WR.isApprox(Eigen::Isometry3d::Identity()));
  ASSERT_EQ(scene.bodies.size(), 3U);
  const SceneBody& lists = scene.body("lists");
  EXPECT_EQ(std::get<Box>(lists.geometry[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<Cylinder>(lists.geometry[1].shape).length, 0.4);
  EXPECT_EQ(std::get<Cylinder>(lists.geometry[1].shape).radius, 0.1);
  EXPECT_LT((lists.geometry[1].X_BG * Eigen::Vector3d::UnitY()).norm(), 1e-12);  // half a turn about x
  // Frame, object pose and shape pose one after the other: a quarter turn each of the first two.
  const SceneBody& maps = scene.body("maps");
  const Eigen::Vector3d centre = maps.X_WB * maps.geometry[0].X_BG.translation();
  EXPECT_TRUE(centre.isApprox(Eigen::Vector3d(-1, 1, 2), 1e-7)) << centre.transpose();
  const SceneBody& meshes = scene.body("meshes");
  EXPECT_NEAR(mass_properties(*std::get<MeshPointer>(meshes.geometry[0].shape)).volume, 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(mass_properties(*std::get<MeshPointer>(meshes.geometry[1].shape)).volume, 2.0 / 6.0, 1e-7);
  EXPECT_NEAR(mass_properties(*std::get<MeshPointer>(meshes.geometry[2].shape)).volume, 1.0 / 6.0, 1e-12);
  EXPECT_TRUE((meshes.geometry[2].X_BG * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d(1, 0, 5), 1e-9));
  EXPECT_TRUE(has_note(scene.notes, "'lists': its subframes are ignored"));
  EXPECT_TRUE(has_note(scene.notes, "allowed_collision_matrix: ignored (1 pairs)"));
  EXPECT_EQ(scene.files.size(), 2U);  // the YAML and the mesh
}

TEST_F(ForeignScenes, AConeContainsItsCircleAndPointsUp) {
  const Scene scene =
      load_scene(write("world: {collision_objects: [{id: c, primitives: [{type: cone, dimensions: [0.6, "
                       "0.2]}], primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]}]}",
                       "moveit.yaml"));
  const auto mesh = std::get<MeshPointer>(scene.bodies[0].geometry[0].shape);
  EXPECT_TRUE(is_closed(*mesh));
  const double volume = mass_properties(*mesh).volume;
  const double of_cone = std::numbers::pi * 0.2 * 0.2 * 0.6 / 3.0;
  EXPECT_GT(volume, of_cone);
  EXPECT_LT(volume, 1.002 * of_cone);
  const Eigen::Index apex = mesh->vertices.cols() - 1;
  EXPECT_TRUE(mesh->vertices.col(apex).isApprox(Eigen::Vector3d(0, 0, 0.3)));
}

TEST_F(ForeignScenes, AFrameThatIsNowhereIsTheWorldWhenAllAreInIt) {
  const auto object = [](const std::string& id, const std::string& frame) {
    return "    - {id: " + id + ", header: {frame_id: '" + frame +
           "'}, primitives: [{type: sphere, dimensions: [1]}], primitive_poses: [{position: [0, 0, 0], orientation: "
           "[0, 0, 0, 1]}]}\n";
  };
  const std::string head = "world:\n  collision_objects:\n";
  const Scene scene = load_scene(write(head + object("a", "base_link") + object("b", "base_link"), "moveit.yaml"));
  EXPECT_TRUE(has_note(scene.notes, "frame 'base_link' is taken for the world"));
  const std::string message = scene_error(head + object("a", "base_link") + object("b", ""));
  EXPECT_NE(message.find("frame 'base_link' has no place"), std::string::npos) << message;
}

TEST_F(ForeignScenes, AnImportPlacesTheRobotAndAddsWhatMoveItLacks) {
  write(kTetrahedron, "package/t.obj");
  write(
      "world: {collision_objects: [{id: can, meshes: [{resource: 'package://things/t.obj'}], mesh_poses: [{position: "
      "[1, 0, 0], orientation: [0, 0, 0, 1]}]}]}",
      "moveit.yaml");
  const Scene scene = load_scene(write(R"(name: mine
import: moveit.yaml
packages: {things: package}
robot_base: {xyz: [0, 0, 0.9144], rpy: [0, 0, 1.5707963267948966]}
object: can
support: board
start: {a: 1}
bodies:
  - {name: board, geometry: [{box: {size: [1, 1, 0.1]}}]}
)",
                                       "mine.yaml"));
  EXPECT_EQ(scene.name, "mine");
  EXPECT_EQ(scene.bodies.size(), 2U);
  EXPECT_EQ(scene.object, "can");
  EXPECT_TRUE((scene.X_WR * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0, 1, 0.9144)));
  EXPECT_EQ(scene.files.size(), 3U);
  const std::string twice =
      "name: m\nimport: moveit.yaml\npackages: {things: package}\nbodies: [{name: can, geometry: [{sphere: {radius: "
      "1}}]}]\n";
  EXPECT_NE(scene_error(twice, "twice.yaml").find("two bodies 'can'"), std::string::npos);
  try {
    load_scene(write("name: m\nimport: moveit.yaml\n", "lost.yaml"));
    ADD_FAILURE() << "accepted a package without a path";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("package 'things' has no path"), std::string::npos) << error.what();
  }
  write("name: m\nbodies: []\n", "ours.yaml");
  EXPECT_NE(scene_error("name: m\nimport: ours.yaml\n", "nested.yaml").find("neither a planning scene"),
            std::string::npos);
  EXPECT_NE(scene_error("name: m\nbodies: []\npackages: {a: b}\n", "idle.yaml").find("imported scene"),
            std::string::npos);
}

TEST_F(ForeignScenes, MeshesStayInTheirPackage) {
  write(kTetrahedron, "package/t.obj");
  write(kTetrahedron, "secret.obj");
  fs::create_symlink(folder_ / "secret.obj", folder_ / "package/out.obj");
  fs::create_symlink("t.obj", folder_ / "package/same.obj");
  const auto scene = [](const std::string& uri) {
    return "world: {collision_objects: [{id: can, meshes: [{resource: '" + uri +
           "'}], mesh_poses: [{position: [1, 0, 0], orientation: [0, 0, 0, 1]}]}]}";
  };
  const fs::path mine = write("name: mine\nimport: moveit.yaml\npackages: {things: package}\n", "mine.yaml");
  write(scene("package://things/same.obj"), "moveit.yaml");
  EXPECT_EQ(load_scene(mine).bodies.size(), 1U);
  for (const std::string uri : {"package://things/../secret.obj", "package://things/out.obj"}) {
    write(scene(uri), "moveit.yaml");
    try {
      load_scene(mine);
      ADD_FAILURE() << "accepted " << uri;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("meshes[0].resource: '" + uri + "' leaves its package"), std::string::npos) << message;
    }
  }
  // A package without a path is looked for above the scene's file, as for a URDF.
  write(scene("package://package/t.obj"), "moveit.yaml");
  EXPECT_EQ(load_scene(folder_ / "moveit.yaml").bodies.size(), 1U);
}

TEST_F(ForeignScenes, MistakesNameTheElement) {
  const auto object = [](const std::string& content) {
    return "world:\n  collision_objects:\n    - id: a\n" + content;
  };
  const std::string pose = "      primitive_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]\n";
  const auto primitive = [&](const std::string& text) { return object("      primitives: [" + text + "]\n" + pose); };
  const auto posed = [&](const std::string& text) {
    return object("      primitives: [{type: sphere, dimensions: [1]}]\n      primitive_poses: [" + text + "]\n");
  };
  const auto mesh = [&](const std::string& text) {
    return object("      meshes: [" + text +
                  "]\n      mesh_poses: [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]\n");
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {"world: {collision_objects: []}\nsurprise: 1\n", ":2: surprise: unknown key"},
      {"world: {}\n", "world: has no key 'collision_objects'"},
      {object(""), "object 'a' needs at least one shape"},
      {primitive("{type: pyramid, dimensions: [1]}"), "type: expected box, sphere, cylinder or cone, found 'pyramid'"},
      {primitive("{type: plane, dimensions: [0, 0, 1, 0]}"), "a plane has no thickness"},
      {object("      planes: [{coef: [0, 0, 1, 0]}]\n"), "planes: a plane has no thickness"},
      {primitive("{type: box, dimensions: [1, 2]}"), "dimensions: expected 3 numbers, found 2"},
      {primitive("{type: cylinder, dimensions: [1, 2, 3]}"), "dimensions: expected 2 numbers, found 3"},
      {primitive("{type: sphere, dimensions: [-1]}"), "dimensions[0]: expected a positive number, found '-1'"},
      {primitive("{type: box, dimensions: [1, .inf, 1]}"), "expected a finite number, found '.inf'"},
      {primitive("{type: box, dimensions: [1, 0, 1]}"), "dimensions[1]: expected a positive number"},
      {primitive("{type: sphere}"), "has no key 'dimensions'"},
      {object("      primitives: [{type: sphere, dimensions: [1]}]\n"), "as many primitive_poses as primitives (1)"},
      {object(pose), "expected as many primitive_poses as primitives (0), found 1"},
      {posed("{position: [0, 0, 0]}"), "has no key 'orientation'"},
      {posed("{position: [0, 0], orientation: [0, 0, 0, 1]}"), "position: expected 3 numbers, found 2"},
      {posed("{position: [0, 0, .nan], orientation: [0, 0, 0, 1]}"), "position[2]: expected a finite number"},
      {posed("{position: [0, 0, 0], orientation: [0, 0, 0, 0]}"), "orientation: expected a unit quaternion"},
      {posed("{position: [0, 0, 0], orientation: {x: 0, y: 0, z: 0}}"), "has no key 'w'"},
      {object("      operation: remove\n"), "operation: expected add (0), found 'remove'"},
      {mesh("{resource: 'package://p/../../secret.stl'}"),
       "meshes[0].resource: 'package://p/../../secret.stl' leaves its package"},
      {mesh("{resource: 'package://p/a.stl'}"), "package 'p' has no path"},
      {mesh("{resource: absent.stl}"), "absent.stl: no such file"},
      {mesh("{vertices: [[0, 0, 0]], triangles: [[0, 0, 1]]}"), "expected the indices of three of the 1 vertices"},
      {mesh("{vertices: [[0, 0, 0]], triangles: []}"), "a mesh without triangles"},
      {mesh("{vertices: [[0, 0, 0], [1, 0, 0]], triangles: [[0, 1, 0]]}"), "triangles: a mesh without triangles"},
      {mesh("{}"), "has no key 'vertices'"},
      {"world:\n  collision_objects:\n    - id: ''\n", "id: expected a name"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = scene_error(text);
    EXPECT_NE(message.find(expected), std::string::npos) << "expected: " << expected << "\nmessage:  " << message;
  }
}

TEST_F(ForeignScenes, AnStlHeaderIsNotBelieved) {
  std::string stl(84, '\0');
  const std::uint32_t announced = 21474836;  // 1 GB
  std::memcpy(stl.data() + 80, &announced, 4);
  write(stl, "huge.stl");
  const std::string message = scene_error(
      "world: {collision_objects: [{id: a, meshes: [{resource: huge.stl}], mesh_poses: [{position: [0, 0, 0], "
      "orientation: [0, 0, 0, 1]}]}]}");
  EXPECT_NE(message.find("announces 21474836 triangles"), std::string::npos) << message;
}

}  // namespace
}  // namespace opponens::robot
