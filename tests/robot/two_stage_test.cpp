// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// The two-stage verdict against the truth: in small what experiments/collision_equality does, and where it could break.
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/rng.hpp"
#include "experiments/collision_equality/comparisons.hpp"
#include "experiments/collision_equality/made_scenes.hpp"
#include "made_robots.hpp"
#include "robot/collision_world.hpp"
#include "robot/load_robot.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using experiments::Subject;
using experiments::Tally;

/// All kinds of comparison; what they count together. No body may be without geometry.
Tally expect_equal(const RobotModel& robot, const Scene& scene, const std::string& name, std::int64_t count = 100) {
  const Subject subject(robot, scene);
  Rng rng = stream(1, name);
  Tally sum;
  for (const auto compare : {experiments::compare_uniform, experiments::compare_motions, experiments::compare_contacts,
                             experiments::compare_flying, experiments::compare_flying_contacts}) {
    const Tally tally = compare(subject, count, rng);
    EXPECT_EQ(tally.different, 0) << name << ": " << tally.example;
    sum.configurations += tally.configurations;
    sum.free += tally.free;
    sum.pairs_asked += tally.pairs_asked;
  }
  return sum;
}

Scene scene_of(const std::vector<std::pair<Shape, Isometry3d>>& bodies) {
  Scene scene;
  for (const auto& [shape, X_WB] : bodies) {
    scene.bodies.push_back({"body_" + std::to_string(scene.bodies.size()), X_WB, {{shape}}});
  }
  return scene;
}

RobotModel ur5_allegro() { return RobotModel(load_robot(ours("ur5_allegro/ur5_allegro_right.yaml"))); }
RobotModel allegro() { return RobotModel(load_hand(ours("ur5_allegro/allegro_right.yaml"))); }

TEST(TwoStage, OurRobotInAllScenes) {
  const RobotModel robot = ur5_allegro();
  std::vector<Scene> scenes = experiments::made_scenes();
  for (const auto& entry : std::filesystem::directory_iterator(ours("scenes"))) {
    if (entry.path().extension() == ".yaml") scenes.push_back(load_scene(entry.path()));
  }
  ASSERT_GE(scenes.size(), 8U);
  for (const Scene& scene : scenes) {
    const Tally tally = expect_equal(robot, scene, scene.name, 150);
    EXPECT_GT(tally.free, tally.configurations / 20) << scene.name;
    EXPECT_LT(tally.free, tally.configurations * 19 / 20) << scene.name;
  }
}

TEST(TwoStage, RandomRobotsAmongRandomBodies) {
  Rng rng(2);
  std::int64_t free = 0;
  std::int64_t all = 0;
  for (int i = 0; i < 30; ++i) {
    const RobotModel robot = random_robot(2 + static_cast<int>(rng.index(8)), 0.3, rng);
    Scene scene;
    scene.X_WR = random_pose(1.0, rng);
    for (std::uint64_t b = rng.index(20); b > 0; --b) {
      scene.bodies.push_back({"body_" + std::to_string(b),
                              scene.X_WR * random_pose(0.8, rng),
                              {{random_shape(0.3, rng), random_pose(0.1, rng)}, {random_shape(0.1, rng)}}});
    }
    const Tally tally = expect_equal(robot, scene, "random " + std::to_string(i), 60);
    free += tally.free;
    all += tally.configurations;
  }
  EXPECT_GT(free, all / 10);
  EXPECT_LT(free, all * 9 / 10);
}

TEST(TwoStage, TheFirstStageDecidesNearlyEverything) {
  const RobotModel robot = ur5_allegro();
  const Scene scene = load_scene(ours("scenes/bottle_shelf.yaml"));
  const CollisionWorld world(robot, scene, {});
  std::size_t pairs = 0;
  for (const std::vector<int>& partners : world.partners) pairs += partners.size();
  const Subject subject(robot, scene);
  Rng rng(3);
  const Tally tally = experiments::compare_uniform(subject, 2000, rng);
  EXPECT_EQ(tally.different, 0) << tally.example;
  // Of all pairs hardly any; where a configuration collides, a point in both parts mostly shows it without the truth.
  EXPECT_GT(pairs, 200U);
  EXPECT_LT(static_cast<double>(tally.pairs_asked), 0.01 * static_cast<double>(pairs) * 2000.0);
  EXPECT_GT(tally.pairs_asked, 0);
  EXPECT_LT(tally.pairs_asked, (tally.configurations - tally.free) / 10);
  const Tally contacts = experiments::compare_contacts(subject, 500, rng);
  EXPECT_GE(contacts.pairs_asked, contacts.configurations / 2);
}

TEST(TwoStage, BatchesOfAnySizeAndTheFirstColliding) {
  const RobotModel robot = ur5_allegro();
  const CollisionChecker checker(robot, load_scene(ours("scenes/box_table.yaml")));
  Rng rng(4);
  for (Eigen::Index rows = 0; rows <= 20; ++rows) {
    ConfigurationBatch batch(rows, robot.dof());
    std::vector<bool> truth;
    std::optional<int> first;
    for (Eigen::Index i = 0; i < rows; ++i) {
      for (Eigen::Index j = 0; j < batch.cols(); ++j) batch(i, j) = rng.uniform(robot.lower()[j], robot.upper()[j]);
      truth.push_back(checker.exact_free(batch.row(i)));
      if (!truth.back() && !first) first = static_cast<int>(i);
    }
    CollisionCounts counts;
    EXPECT_EQ(checker.free_rows(batch, &counts), truth);
    EXPECT_EQ(counts.configurations, rows);
    EXPECT_EQ(checker.first_colliding(batch), first);
  }
  EXPECT_THROW(checker.free_rows(ConfigurationBatch::Zero(3, 2)), std::invalid_argument);
  ConfigurationBatch bad = ConfigurationBatch::Zero(9, robot.dof());
  bad(8, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(checker.free_rows(bad), std::invalid_argument);
  EXPECT_THROW(checker.first_colliding(bad), std::invalid_argument);
}

TEST(TwoStage, RobotsWithoutGeometryOrScenesWithoutBodies) {
  RobotBuilder bare({});
  bare.add(0, JointType::revolute, Vector3d::UnitZ(), at(0, 0, 0.1), {});
  const Scene ball = scene_of({{Sphere{1}, at(0, 0, 0)}});
  for (const Scene& scene : {Scene{}, ball}) {
    const Tally tally = expect_equal(bare.model(), scene, "bare", 20);
    EXPECT_EQ(tally.free, tally.configurations);
  }
  Rng rng(5);
  expect_equal(random_robot(8, 0.2, rng), {}, "alone");
  expect_equal(allegro(), {}, "hand alone");
  EXPECT_GT(expect_equal(ur5_allegro(), {}, "robot alone").free, 0);
  Scene hollow = ball;
  hollow.bodies.push_back({"nothing", at(0, 0, 0), {}});
  EXPECT_TRUE(CollisionChecker(bare.model(), hollow).free(VectorXd::Zero(1)));
  EXPECT_FALSE(CollisionChecker(ur5_allegro(), hollow).free(VectorXd::Zero(22)));
}

TEST(TwoStage, ARobotWithoutJoints) {
  RobotBuilder builder({{Box{{0.1, 0.1, 0.1}}}});
  builder.add(0, JointType::fixed, Vector3d::UnitX(), at(0, 0, 0.5), {{mesh_of(torus(0.1, 0.02))}});
  const RobotModel robot = builder.model();
  ASSERT_EQ(robot.dof(), 0);
  const VectorXd none(0);
  const CollisionChecker alone(robot, {});
  EXPECT_TRUE(alone.free(none));
  EXPECT_EQ(alone.free_rows(ConfigurationBatch(11, 0)), std::vector<bool>(11, true));
  EXPECT_FALSE(alone.first_colliding(ConfigurationBatch(11, 0)).has_value());
  const CollisionChecker blocked(robot, scene_of({{Box{{0.1, 0.1, 0.1}}, at(0.09, 0, 0)}}));
  EXPECT_FALSE(blocked.free(none));
  EXPECT_FALSE(blocked.exact_free(none));
  EXPECT_EQ(blocked.free_rows(ConfigurationBatch(9, 0)), std::vector<bool>(9, false));
  EXPECT_TRUE(blocked.free(at(0, 0, 1), none));
  EXPECT_FALSE(blocked.free(at(0, 0.01, 0), none));
  expect_equal(robot, scene_of({{Box{{0.1, 0.1, 0.1}}, at(0.5, 0, 0)}}), "no joints", 30);
}

TEST(TwoStage, GiantFarAndTinyBodies) {
  const RobotModel robot = ur5_allegro();
  const Shape giant_mesh = mesh_of(triangulate(Box{{200, 200, 200}}));
  expect_equal(robot, scene_of({{Box{{200, 200, 1}}, at(0, 0, -0.55)}, {Box{{0.1, 0.1, 0.1}}, at(0.5, 0, 0.3)}}),
               "giant floor");
  expect_equal(robot, scene_of({{giant_mesh, at(100.6, 0, 0)}}), "giant mesh", 60);
  expect_equal(robot, scene_of({{Cylinder{100, 200}, at(-100.4, 0, 0)}, {Sphere{200}, at(0, 0, -200.1)}}),
               "giant round");
  expect_equal(robot, scene_of({{Sphere{0.2}, at(1000, 0, 0)}, {Box{{0.2, 0.2, 0.2}}, at(0.4, 0.2, 0.5)}}), "far body");
  Rng rng(6);
  Scene tiny;
  for (int i = 0; i < 400; ++i) {
    const Shape shape = i % 4 == 0   ? Shape(Box{{1e-4, 1e-4, 1e-4}})
                        : i % 4 == 1 ? Shape(Sphere{5e-5})
                        : i % 4 == 2 ? Shape(Cylinder{5e-5, 1e-4})
                                     : mesh_of(torus(5e-5, 2e-5, 8));
    tiny.bodies.push_back({"dust_" + std::to_string(i), random_pose(0.7, rng), {{shape}}});
  }
  const Tally among_dust = expect_equal(allegro(), tiny, "dust");
  EXPECT_LT(among_dust.free, among_dust.configurations);
}

TEST(TwoStage, TrianglesAndFlatMeshes) {
  TriangleMesh triangle;
  triangle.vertices.resize(3, 3);
  triangle.vertices << 0, 0.3, 0, 0, 0, 0.3, 0, 0, 0.1;
  triangle.triangles.resize(3, 1);
  triangle.triangles << 0, 1, 2;
  TriangleMesh line = triangle;  // no area
  line.vertices << 0, 0.1, 0.3, 0, 0.1, 0.3, 0, 0.1, 0.3;
  TriangleMesh grid;
  grid.vertices.resize(3, 4);
  grid.vertices << 0, 0.4, 0.4, 0, 0, 0, 0.4, 0.4, 0.2, 0.2, 0.2, 0.2;
  grid.triangles.resize(3, 4);  // there and back: closed, without volume
  grid.triangles << 0, 0, 0, 0, 1, 2, 2, 3, 2, 3, 1, 2;
  std::vector<Shape> shapes{mesh_of(triangle), mesh_of(line), mesh_of(grid)};
  Rng rng(7);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    expect_equal(ur5_allegro(), scene_of({{shapes[i], at(0.3, 0.1, 0.3)}}), "flat body " + std::to_string(i), 60);
    RobotBuilder builder({{shapes[i]}});
    builder.add(0, JointType::revolute, Vector3d::UnitY(), at(0.2, 0, 0.2), {{shapes[i]}});
    builder.add(1, JointType::prismatic, Vector3d(0, 0, -1), at(0.2, 0.1, 0.2), {{shapes[(i + 1) % 3]}});
    builder.add(2, JointType::revolute, Vector3d::UnitX(), at(0, 0.1, 0), {{shapes[(i + 2) % 3]}});
    expect_equal(builder.model(), scene_of({{Box{{0.2, 0.2, 0.2}}, at(0.4, 0, 0.2)}, {shapes[i], at(0, 0.2, 0)}}),
                 "flat robot " + std::to_string(i), 60);
  }
}

TEST(TwoStage, WhatNoJointMoves) {
  // Deep, flush (rounding decides, and differs from pose to pose), and hairline gaps, with the scene and within.
  for (const double gap : {-0.05, 0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1.5e-6, 3e-6, 1e-3}) {
    for (const double turn : {0.0, 0.7}) {
      const auto turned = [&](double x) {
        return Isometry3d(Eigen::AngleAxisd(turn, Vector3d(1, 2, 3).normalized())) * at(x, 0, 0);
      };
      RobotBuilder builder({{Box{{0.2, 0.2, 0.2}}, turned(0)}});
      builder.add(0, JointType::fixed, Vector3d::UnitX(), at(0, 0, 0), {});
      builder.add(1, JointType::fixed, Vector3d::UnitX(), at(0, 0, 0), {{Box{{0.2, 0.1, 0.1}}, turned(0.2 + gap)}});
      builder.add(2, JointType::revolute, Vector3d::UnitX(), at(0, 0, 0.5), {{Sphere{0.05}}});
      const Scene scene = scene_of({{Box{{0.2, 0.1, 0.1}}, turned(-0.2 - gap)}, {Sphere{0.1}, at(0.1, 0, 0.6)}});
      const Tally tally = expect_equal(builder.model(), scene, "constant", 60);
      EXPECT_TRUE(gap >= 0.0 || tally.free == 0);
    }
  }
}

TEST(TwoStage, TwoArmsOnOneRoot) {
  RobotBuilder builder({{Box{{0.2, 0.6, 0.1}}}});
  for (const double side : {-1.0, 1.0}) {
    int parent = 0;
    for (int i = 0; i < 4; ++i) {
      const Isometry3d X_PJ = i == 0 ? at(0, 0.25 * side, 0.06) : at(0.25, 0, 0);
      const Vector3d axis = i % 2 == 0 ? Vector3d(0, 0, side) : Vector3d(0, side, 0);
      Geometry bar{Cylinder{0.03, 0.2}};
      bar.X_BG = at(0.12, 0, 0) * Eigen::AngleAxisd(1.5707963267948966, Vector3d::UnitY());
      builder.add(parent, JointType::revolute, axis, X_PJ, {bar, {mesh_of(torus(0.04, 0.01, 16)), at(0.2, 0, 0)}});
      parent = static_cast<int>(builder.robot.joints.size());
    }
  }
  const Tally tally =
      expect_equal(builder.model(), scene_of({{Box{{0.3, 0.3, 0.3}}, at(0.6, 0, 0.2)}}), "two arms", 500);
  EXPECT_GT(tally.free, 0);
  EXPECT_LT(tally.free, tally.configurations);
}

TEST(TwoStage, PositionsBeyondWhatFloatsHold) {
  // A slide carries two parts far out, which touch by less than a float resolves there.
  RobotBuilder builder({});
  Joint& slide = builder.add(0, JointType::prismatic, Vector3d::UnitX(), at(0, 0, 0), {});
  slide.lower = -0.5;
  slide.upper = 0.5;
  builder.add(1, JointType::revolute, Vector3d(1, 2, 3).normalized(), at(0, 0, 0), {{Box{{0.2, 0.2, 0.2}}}});
  builder.add(2, JointType::fixed, Vector3d::UnitX(), at(0, 0, 0), {});
  builder.add(3, JointType::prismatic, Vector3d::UnitY(), at(0, 0, 0), {{Box{{0.2, 0.2, 0.2}}}});
  const RobotModel robot = builder.model();
  const CollisionChecker checker(robot, scene_of({{Sphere{0.1}, at(3, 0, 0)}}));
  Rng rng(8);
  int free = 0;
  for (int i = 0; i < 300; ++i) {
    const double far = std::pow(10.0, rng.uniform(0, 300));
    ConfigurationBatch batch(8, 3);
    for (int row = 0; row < 8; ++row) {
      batch.row(row) << rng.uniform(-0.5, 0.5), rng.uniform(-3, 3), 0.2 + rng.uniform(-1e-6, 1e-6);
      if (row % 3 == 1) batch(row, 0) = std::min(far, 9e3);
      if (row % 3 == 2) batch(row, static_cast<Eigen::Index>(rng.index(2))) = far;
    }
    const std::vector<bool> found = checker.free_rows(batch);
    for (int row = 0; row < 8; ++row) {
      const VectorXd q = batch.row(row);
      EXPECT_EQ(found[static_cast<std::size_t>(row)], checker.exact_free(q)) << q.transpose();
      EXPECT_EQ(checker.free(q), checker.exact_free(q)) << q.transpose();
      free += found[static_cast<std::size_t>(row)] ? 1 : 0;
    }
  }
  EXPECT_GT(free, 0);
  EXPECT_LT(free, 2400);
}

TEST(TwoStage, RootsFarAwayAndWorldsBeyondFloats) {
  const RobotModel hand = allegro();
  const Scene mugs = experiments::made_scenes()[2];
  const CollisionChecker checker(hand, mugs);
  Rng rng(9);
  for (const double far : {0.5, 2.0, 1e3, 1e7, 1e15}) {
    for (int i = 0; i < 50; ++i) {
      VectorXd q(hand.dof());
      for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng.uniform(hand.lower()[j], hand.upper()[j]);
      const Isometry3d X_WR = random_pose(far, rng);
      EXPECT_EQ(checker.free(X_WR, q), checker.colliding_pairs(X_WR, q).empty()) << far;
    }
  }
  for (const double far : {1e5, 1e7, 1e20, 1e39}) {
    const Scene scene = scene_of({{Box{{0.2, 0.2, 0.2}}, at(0.1, 0, 0)}, {Sphere{1}, at(far, -far, 0)}});
    const CollisionChecker with_far(hand, scene);
    int blocked = 0;
    for (int i = 0; i < 50; ++i) {
      VectorXd q(hand.dof());
      for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = rng.uniform(hand.lower()[j], hand.upper()[j]);
      EXPECT_EQ(with_far.free(q), with_far.exact_free(q)) << far;
      const Isometry3d X_WR = random_pose(0.4, rng);
      const bool free = with_far.free(X_WR, q);
      EXPECT_EQ(free, with_far.colliding_pairs(X_WR, q).empty()) << far;
      blocked += free ? 0 : 1;
    }
    EXPECT_GT(blocked, 0);
    EXPECT_LT(blocked, 50);
  }
}

}  // namespace
}  // namespace opponens::robot
