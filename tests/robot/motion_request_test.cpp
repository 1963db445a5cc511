// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/motion_request.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include <gtest/gtest.h>

#include "foreign_scenes.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh_check.hpp"
#include "robot/scene.hpp"

namespace opponens::robot {
namespace {

namespace fs = std::filesystem;

TEST_F(ForeignScenes, ReadsARequestAndCompletesIt) {
  const MotionRequest request = load_motion_request(write(R"(group_name: arm
start_state: {joint_state: {name: [shoulder_pan_joint, gripper], position: [1, 2]}}
goal_constraints:
  - joint_constraints: [{joint_name: elbow_joint, position: 0.5, tolerance_above: 0.1}]
  - joint_constraints: [{joint_name: elbow_joint, position: -0.5}]
path_constraints: {joint_constraints: [{joint_name: a, position: 0}]}
)",
                                                          "request.yaml"));
  EXPECT_EQ(request.name, "request");
  EXPECT_EQ(request.group, "arm");
  ASSERT_EQ(request.goals.size(), 2U);
  EXPECT_TRUE(has_note(request.notes, "path_constraints: ignored"));
  const RobotModel robot(load_robot(fs::path(OPPONENS_SOURCE_DIR) / "models/ur5_allegro/ur5_allegro_right.yaml"));
  Eigen::VectorXd fallback = Eigen::VectorXd::Constant(robot.dof(), 0.25);
  const Completed start = complete(robot, request.start, fallback);
  EXPECT_EQ(start.unknown, std::vector<std::string>{"gripper"});
  EXPECT_EQ(static_cast<int>(start.assumed.size()), robot.dof() - 1);
  fallback[0] = 1.0;
  EXPECT_EQ(start.q, fallback);
  const Completed goal = complete(robot, request.goals[1], start.q);
  fallback[2] = -0.5;
  EXPECT_EQ(goal.q, fallback);
}

TEST_F(ForeignScenes, MistakesInRequestsNameTheElement) {
  const std::string start = "start_state: {joint_state: {name: [a], position: [0]}}\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {start, "has no key 'goal_constraints'"},
      {start + "goal_constraints: []\n", "expected at least one goal"},
      {start + "goal_constraints: [{position_constraints: [{link_name: a}]}]\n", "expected joint_constraints"},
      {start + "goal_constraints: [{joint_constraints: [{joint_name: a}]}]\n", "has no key 'position'"},
      {start + "goal_constraints: [{joint_constraints: [{joint_name: a, position: .inf}]}]\n", "finite number"},
      {start +
           "goal_constraints: [{joint_constraints: [{joint_name: a, position: 0}, {joint_name: a, position: 1}]}]\n",
       "joint 'a' occurs twice"},
      {"start_state: {joint_state: {name: [a, b], position: [0]}}\ngoal_constraints: []\n",
       "position: expected 2 numbers, found 1"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = error_of([](const fs::path& file) { load_motion_request(file); }, text, "request.yaml");
    EXPECT_NE(message.find(expected), std::string::npos) << "expected: " << expected << "\nmessage:  " << message;
  }
}

TEST(MotionBenchMaker, EverySceneAndRequestLoads) {
  const fs::path root = fs::path(OPPONENS_SHARED_DATA) / "data/scenes";
  if (!fs::exists(root)) GTEST_SKIP() << "needs " << root;
  int scenes = 0;
  int requests = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".yaml") continue;
    if (name.starts_with("request")) {
      const MotionRequest request = load_motion_request(entry.path());
      EXPECT_EQ(request.start.names.size(), 12U) << name;
      EXPECT_EQ(request.goals.size(), 1U) << name;
      EXPECT_EQ(request.goals[0].names.size(), 6U) << name;
      ++requests;
    } else if (name.starts_with("scene")) {
      const Scene scene = load_scene(entry.path());
      EXPECT_GE(scene.bodies.size(), 6U) << name;
      EXPECT_TRUE(mesh_warnings(scene).empty()) << name;
      ++scenes;
    }
  }
  EXPECT_EQ(requests, 60);
  EXPECT_EQ(scenes, 67);  // 60 problems and 7 nominal scenes
}

/// The query of the table problems puts the tool 0.2 m in front of the can and 25 mm above its middle. That holds for
/// the base that docs/scene_files.md names, and ties arm, object poses, shape poses and base together.
TEST(MotionBenchMaker, GoalsPutTheToolBeforeTheCan) {
  const fs::path shared = OPPONENS_SHARED_DATA;
  if (!fs::exists(shared / "data/scenes")) GTEST_SKIP() << "needs " << shared;
  ASSERT_EQ(setenv("OPPONENS_ROBOT_DATA", (shared / "data/robots").c_str(), 1), 0);
  const RobotModel robot(load_robot(fs::path(OPPONENS_SOURCE_DIR) / "experiments/motion_bench_maker/ur5.yaml"));
  EXPECT_EQ(robot.dof(), 6);
  EXPECT_TRUE(robot.description().hand_joints.empty());
  Eigen::Isometry3d X_WR = Eigen::Isometry3d::Identity();
  X_WR.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_WR.translation().z() = 0.9144;
  const auto tool = static_cast<std::size_t>(robot.link_index("tool0"));
  for (int i = 1; i <= 20; ++i) {
    const std::string number = (i < 10 ? "000" : "00") + std::to_string(i) + ".yaml";
    const fs::path folder = shared / "data/scenes/ur5_problems/table_pick_ur5";
    const Scene scene = load_scene(folder / ("scene" + number));
    const MotionRequest request = load_motion_request(folder / ("request" + number));
    const Completed goal = complete(robot, request.goals[0], Eigen::VectorXd::Zero(6));
    const Eigen::Isometry3d X_WT = X_WR * robot.link_poses(goal.q)[tool];
    const SceneBody& can = scene.body("Can1");
    const Eigen::Vector3d p_TC = X_WT.inverse() * (can.X_WB * can.geometry[0].X_BG.translation());
    EXPECT_NEAR(p_TC.z(), 0.2, 0.01) << number;
    EXPECT_NEAR((X_WT.linear() * p_TC).z(), -0.025, 0.005) << number;
    EXPECT_NEAR(p_TC.head<2>().norm(), 0.025, 0.005) << number;
  }
}

}  // namespace
}  // namespace opponens::robot
