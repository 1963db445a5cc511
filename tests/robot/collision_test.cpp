// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/collision.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"
#include "robot/narrow_phase.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace fs = std::filesystem;
const fs::path kModels = fs::path(OPPONENS_SOURCE_DIR) / "models";

/// A planar arm of three bars of 1 m that turn about z, bars 0.2 m wide. Neighbours may touch.
RobotDescription folding_arm() {
  RobotDescription arm;
  arm.name = "folding";
  for (int i = 0; i < 3; ++i) {
    Link link;
    link.name = "bar_" + std::to_string(i);
    link.joint = i - 1;
    Geometry bar{Box{{1.0, 0.2, 0.2}}};
    bar.X_BG = at(0.5, 0, 0);
    link.collision = {bar};
    arm.links.push_back(link);
    if (i == 0) continue;
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = JointType::revolute;
    joint.parent = i - 1;
    joint.child = i;
    joint.X_PJ = at(1, 0, 0);
    joint.axis = Vector3d::UnitZ();
    joint.lower = -4;
    joint.upper = 4;
    arm.joints.push_back(joint);
    arm.allowed_collisions.insert({i - 1, i});
  }
  arm.hand_joints = {"joint_1", "joint_2"};
  arm.palm_link = "bar_2";
  arm.weights = VectorXd::Ones(2);
  return arm;
}

Scene scene_with(const Shape& shape, const Isometry3d& X_WB) {
  Scene scene;
  scene.bodies.push_back({"block", X_WB, {{shape}}});
  return scene;
}

TEST(CollisionChecker, AFoldedArmMeetsItself) {
  const RobotModel robot(folding_arm());
  const CollisionChecker checker(robot, Scene{});
  EXPECT_TRUE(checker.free(Eigen::Vector2d(0, 0)));
  EXPECT_NEAR(checker.clearance(Eigen::Vector2d(0, 0)).distance, 1.0, 1e-6);
  const Eigen::Vector2d folded(2.6, 2.6);
  EXPECT_FALSE(checker.free(folded));
  EXPECT_EQ(checker.colliding_pairs(folded), (std::vector<BodyPair>{{"bar_0", "bar_2"}}));
  EXPECT_EQ(checker.clearance(folded).distance, 0.0);
  // Neighbours overlap in every pose but are allowed; without the allowance they are reported.
  RobotDescription strict = folding_arm();
  strict.allowed_collisions.clear();
  EXPECT_EQ(CollisionChecker(RobotModel(strict), Scene{}).colliding_pairs(Eigen::Vector2d(0, 0)),
            (std::vector<BodyPair>{{"bar_0", "bar_1"}, {"bar_1", "bar_2"}}));
}

TEST(CollisionChecker, SceneTouchingAndMovedRoot) {
  const RobotModel robot(folding_arm());
  const Scene scene = scene_with(Box{{0.2, 0.2, 0.2}}, at(2.5, 0, 0));
  const CollisionChecker checker(robot, scene);
  EXPECT_EQ(checker.colliding_pairs(Eigen::Vector2d(0, 0)), (std::vector<BodyPair>{{"bar_2", "block"}}));
  EXPECT_TRUE(checker.free(Eigen::Vector2d(1.5, 0)));
  EXPECT_TRUE(checker.free(at(0, 0, 1), Eigen::Vector2d(0, 0)));
  EXPECT_EQ(checker.colliding_pairs(at(2, 0, 0), Eigen::Vector2d(0, 0)), (std::vector<BodyPair>{{"bar_0", "block"}}));
  for (const BodyPair& pair : {BodyPair{"bar_2", "block"}, BodyPair{"block", "bar_2"}}) {
    const CollisionChecker touching(robot, scene, {pair});
    EXPECT_TRUE(touching.free(Eigen::Vector2d(0, 0)));
    EXPECT_FALSE(touching.free(at(2, 0, 0), Eigen::Vector2d(0, 0)));
  }
  EXPECT_THROW(CollisionChecker(robot, scene, {{"bar_9", "block"}}), std::invalid_argument);
  EXPECT_THROW(checker.free(VectorXd::Zero(3)), std::invalid_argument);
  EXPECT_THROW(checker.free(Eigen::Vector2d(0, std::nan(""))), std::invalid_argument);
}

TEST(CollisionChecker, ClosedMeshesAreSolidsOpenOnesAreReported) {
  const RobotModel robot(folding_arm());
  TriangleMesh room = triangulate(Box{{20, 20, 20}});
  const Shape closed = std::make_shared<TriangleMesh>(room);
  EXPECT_EQ(CollisionChecker(robot, scene_with(closed, at(0, 0, 0))).colliding_pairs(Eigen::Vector2d(0, 0)).size(), 3U);
  EXPECT_TRUE(CollisionChecker(robot, scene_with(closed, at(0, 0, 0))).open_meshes().empty());
  room.triangles.conservativeResize(3, 11);
  const CollisionChecker open(robot, scene_with(std::make_shared<TriangleMesh>(room), at(0, 0, 0)));
  EXPECT_TRUE(open.free(Eigen::Vector2d(0, 0)));
  EXPECT_EQ(open.open_meshes(), (std::vector<std::string>{"block"}));
}

TEST(CollisionChecker, NothingToCheckIsFree) {
  RobotDescription bare = folding_arm();
  for (Link& link : bare.links) link.collision.clear();
  const CollisionChecker checker(RobotModel(bare), scene_with(Sphere{1}, at(0, 0, 0)));
  EXPECT_TRUE(checker.free(Eigen::Vector2d(0, 0)));
  EXPECT_TRUE(std::isinf(checker.clearance(Eigen::Vector2d(0, 0)).distance));
}

/// Every pair through the narrow phase alone, without bounding volumes: what the checker has to agree with.
std::vector<BodyPair> all_pairs(const RobotModel& robot, const Scene& scene, const VectorXd& q) {
  std::set<BodyPair> pairs;
  const std::vector<Isometry3d> X_RL = robot.link_poses(q);
  const auto meet = [](const std::vector<Geometry>& a, const Isometry3d& X_WA, const std::vector<Geometry>& b,
                       const Isometry3d& X_WB) {
    return std::any_of(a.begin(), a.end(), [&](const Geometry& x) {
      return std::any_of(b.begin(), b.end(), [&](const Geometry& y) {
        return intersect(CollisionShape(x.shape), X_WA * x.X_BG, CollisionShape(y.shape), X_WB * y.X_BG);
      });
    });
  };
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    const Link& link = robot.links()[i];
    const Isometry3d X_WL = scene.X_WR * X_RL[i];
    for (const SceneBody& body : scene.bodies) {
      if (meet(link.collision, X_WL, body.geometry, body.X_WB)) pairs.emplace(link.name, body.name);
    }
    for (std::size_t j = i + 1; j < robot.links().size(); ++j) {
      const Link& other = robot.links()[j];
      if (robot.description().allowed_collisions.count({static_cast<int>(i), static_cast<int>(j)}) == 1) continue;
      if (meet(link.collision, X_WL, other.collision, scene.X_WR * X_RL[j])) {
        pairs.insert(std::minmax(link.name, other.name));
      }
    }
  }
  return {pairs.begin(), pairs.end()};
}

VectorXd random_configuration(const RobotModel& robot, Rng& rng) {
  VectorXd q(robot.dof());
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = rng.uniform(robot.lower()[i], robot.upper()[i]);
  return q;
}

struct ShelfTask {
  RobotModel robot{load_robot(kModels / "ur5_allegro/ur5_allegro_right.yaml")};
  Scene scene = load_scene(kModels / "scenes/bottle_shelf.yaml");
};

TEST(CollisionChecker, BoundingVolumesNeverChangeTheVerdict) {
  const ShelfTask task;
  // Boxes only: preparing the bottles' meshes again for every pair would take minutes.
  Scene boxes = task.scene;
  std::erase_if(boxes.bodies, [](const SceneBody& body) { return body.name.starts_with("bottle"); });
  const CollisionChecker checker(task.robot, boxes);
  Rng rng(31);
  int free = 0;
  for (int i = 0; i < 400; ++i) {
    const VectorXd q = random_configuration(task.robot, rng);
    const std::vector<BodyPair> pairs = checker.colliding_pairs(q);
    EXPECT_EQ(pairs, all_pairs(task.robot, boxes, q)) << q.transpose();
    EXPECT_EQ(checker.free(q), pairs.empty());
    free += pairs.empty() ? 1 : 0;
  }
  EXPECT_GT(free, 10);
  EXPECT_LT(free, 390);
}

TEST(CollisionChecker, ClearanceIsPositiveExactlyWhenFree) {
  const ShelfTask task;
  const CollisionChecker checker(task.robot, task.scene);
  const Isometry3d X_VW = at(1, -2, 0.5) * Eigen::AngleAxisd(0.8, Vector3d(1, 2, -1).normalized());
  Scene moved = task.scene;
  moved.X_WR = X_VW * moved.X_WR;
  for (SceneBody& body : moved.bodies) body.X_WB = X_VW * body.X_WB;
  const CollisionChecker elsewhere(task.robot, moved);
  Rng rng(32);
  int free = 0;
  for (int i = 0; i < 500; ++i) {
    const VectorXd q = random_configuration(task.robot, rng);
    const CollisionChecker::Clearance clearance = checker.clearance(q);
    EXPECT_EQ(clearance.distance > 0.0, checker.free(q)) << q.transpose();
    if (clearance.distance == 0.0) {
      const std::vector<BodyPair> pairs = checker.colliding_pairs(q);
      EXPECT_NE(std::find(pairs.begin(), pairs.end(), clearance.pair), pairs.end());
    } else {
      ++free;
    }
    // Moving robot and scene together changes nothing (within rounding of a contact).
    if (clearance.distance > 0.0 && clearance.distance < 1e-5) continue;
    EXPECT_EQ(elsewhere.colliding_pairs(q), checker.colliding_pairs(q)) << q.transpose();
  }
  EXPECT_GT(free, 10);
}

TEST(CollisionChecker, ClearanceBoundsTheMotionThatStaysFree) {
  // Moving the whole robot by less than its clearance to the scene cannot make it touch the scene.
  const RobotModel robot(folding_arm());
  const CollisionChecker checker(robot, scene_with(Cylinder{0.3, 0.8}, at(1.2, 1.3, 0.1)));
  Rng rng(33);
  int tried = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d q(rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5));
    const double clearance = checker.clearance(q).distance;
    if (clearance == 0.0) continue;
    const Vector3d step = Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized() * (clearance - 1e-6);
    EXPECT_TRUE(checker.free(at(step.x(), step.y(), step.z()), q)) << q.transpose();
    ++tried;
  }
  EXPECT_GT(tried, 100);
}

TEST(CollisionChecker, ThreadsGetTheSameAnswers) {
  const ShelfTask task;
  const CollisionChecker checker(task.robot, task.scene);
  Rng rng(34);
  std::vector<VectorXd> configurations;
  for (int i = 0; i < 400; ++i) configurations.push_back(random_configuration(task.robot, rng));
  const auto verdicts = [&] {
    std::vector<bool> result;
    for (const VectorXd& q : configurations) result.push_back(checker.free(q));
    return result;
  };
  const std::vector<bool> expected = verdicts();
  std::vector<std::vector<bool>> found(4);
  std::vector<std::thread> threads;
  for (std::vector<bool>& result : found) threads.emplace_back([&] { result = verdicts(); });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<bool>& result : found) EXPECT_EQ(result, expected);
}

}  // namespace
}  // namespace opponens::robot
