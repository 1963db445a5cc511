// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "foreign_scenes.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {
namespace {

TEST_F(ForeignScenes, ReadsTheTextFormOfBothAges) {
  const Scene old_form = load_scene(write(R"((noname)+
* tall can
1
cylinder
0.03 0.2
1 0 0.1
0 0 0 1
0 0 0 0
* board
2
box
1 2 0.1
0 0 0
0 0 0 1
0 0 0 0
mesh
4 4
0 0 0
1 0 0
0 1 0
0 0 1
0 2 1
0 1 3
0 3 2
1 2 3
0 0 1
0 0 0 1
0 0 0 0
.
)",
                                          "old.scene"));
  EXPECT_EQ(old_form.name, "old");
  EXPECT_EQ(std::get<Cylinder>(old_form.body("tall can").geometry[0].shape).length, 0.2);
  EXPECT_EQ(old_form.body("board").geometry.size(), 2U);
  const Scene new_form = load_scene(write(R"(kitchen
* cup
1 2 3
0 0 0 1
1
cone
0.1 0.3
0 0 0.5
0 0 0 1
0 0 0 0
1
handle
0 0 0
0 0 0 1
.
)",
                                          "new.scene"));
  EXPECT_EQ(new_form.name, "kitchen");
  const SceneBody& cup = new_form.body("cup");
  EXPECT_TRUE((cup.X_WB * cup.geometry[0].X_BG.translation()).isApprox(Eigen::Vector3d(1, 2, 3.5)));
  EXPECT_TRUE(has_note(new_form.notes, "subframes"));
}

TEST_F(ForeignScenes, MistakesInTheTextFormNameObjectAndLine) {
  const std::string head = "s\n* a\n1\n";
  const std::string pose = "0 0 0\n0 0 0 1\n0 0 0 0\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"s\nbox\n", ":2: expected '*' before an object or '.' at the end, found 'box'"},
      {"s\n", "found ''"},
      {head + "plane\n0 0 1 0\n" + pose + ".\n", ":4: object 'a': a plane"},
      {head + "torus\n1 1\n" + pose + ".\n", "found 'torus'"},
      {head + "box\n1 -1 1\n" + pose + ".\n", ":5: object 'a': expected a positive number"},
      {head + "box\n1 1 nan\n" + pose + ".\n", "expected a finite number, found 'nan'"},
      {head + "sphere\n1\n0 0 0\n0 0 0 0\n0 0 0 0\n.\n", "unit quaternion"},
      {head + "mesh\n100000000 100000000\n", "announces 100000000 vertices"},
      {head + "mesh\n1e300 1\n", "announces 1e300 vertices"},
      {head + "mesh\n2 1\n0 0 0\n1 0 0\n0 1 0\n" + pose + ".\n", "object 'a': a mesh without triangles"},
      {"s\n* a\n0\n.\n", "needs at least one shape"},
      {head + "sphere\n1\n" + pose + "* a\n1\nsphere\n1\n" + pose + ".\n", "two objects of that name"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = scene_error(text, "bad.scene");
    EXPECT_NE(message.find(expected), std::string::npos) << "expected: " << expected << "\nmessage:  " << message;
  }
  std::filesystem::create_symlink("/dev/zero", folder_ / "endless.scene");
  EXPECT_THROW(load_scene(folder_ / "endless.scene"), InputError);
}

}  // namespace
}  // namespace opponens::robot
