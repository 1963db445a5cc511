// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_objective.hpp"

#include <gtest/gtest.h>

#include "allegro.hpp"
#include "core/rng.hpp"
#include "grasp/hand_seed.hpp"
#include "random_contacts.hpp"

namespace opponens::grasp {
namespace {

/// A parallel gripper: one sliding joint, and one that copies it with the opposite sign; palm looks along x.
robot::RobotModel gripper() {
  robot::RobotDescription d;
  d.name = "gripper";
  d.palm_link = "palm";
  d.hand_joints = {"left"};
  const robot::Shape block = robot::Box{Eigen::Vector3d(0.06, 0.02, 0.02)};
  d.links = {{"palm", -1, {{robot::Box{Eigen::Vector3d(0.02, 0.12, 0.04)}, Eigen::Isometry3d::Identity()}}},
             {"left_finger", 0, {{block, Eigen::Isometry3d::Identity()}}},
             {"right_finger", 1, {{block, Eigen::Isometry3d::Identity()}}}};
  for (int i = 0; i < 2; ++i) {
    robot::Joint joint;
    joint.name = i == 0 ? "left" : "right";
    joint.type = robot::JointType::prismatic;
    joint.parent = 0;
    joint.child = i + 1;
    joint.X_PJ.translation() = Eigen::Vector3d(0.05, i == 0 ? 0.06 : -0.06, 0.0);
    joint.axis = Eigen::Vector3d::UnitY();
    joint.lower = i == 0 ? -0.05 : 0.0;
    joint.upper = i == 0 ? 0.0 : 0.05;
    if (i == 1) joint.mimic = robot::Mimic{"left", -1.0, 0.0};
    d.joints.push_back(joint);
  }
  d.contact_points = {{"left", "left", 1, {0.01, -0.01, 0.0}, -Eigen::Vector3d::UnitY()},
                      {"right", "right", 2, {0.01, 0.01, 0.0}, Eigen::Vector3d::UnitY()},
                      {"palm", "palm", 0, {0.01, 0.0, 0.0}, Eigen::Vector3d::UnitX()}};
  d.weights = Eigen::VectorXd::Ones(1);
  return robot::RobotModel(d);
}

struct Setting {
  const robot::RobotModel& hand;
  SynergyBox box;
  robot::Scene scene;
};

void expect_gradient(const Setting& setting, int points, std::uint64_t seed) {
  Rng rng = stream(seed, "objective");
  const GraspTarget target = make_target(setting.scene, "object", 2);
  const HandSurface surface = hand_surface(setting.hand, setting.box.center);
  GraspObjective objective(setting.hand, surface, target, setting.box);
  double largest = 0.0;
  for (int i = 0; i < points; ++i) {
    HandSeed at;
    at.y = Eigen::VectorXd::Zero(setting.box.half_width.size());
    at.X_OH.linear() = Eigen::AngleAxisd(rng.uniform(0, 3), test::random_unit(rng)).toRotationMatrix();
    at.X_OH.translation() = 0.06 * test::random_unit(rng);
    Eigen::VectorXd x(objective.size());
    for (Eigen::Index j = 0; j < x.size(); ++j) x[j] = rng.uniform(-0.4, 0.4);
    Eigen::VectorXd gradient;
    objective.evaluate(at, x, &gradient);
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double h = 1e-7;
      Eigen::VectorXd up = x;
      Eigen::VectorXd down = x;
      up[j] += h;
      down[j] -= h;
      const double slope = (objective.evaluate(at, up, nullptr) - objective.evaluate(at, down, nullptr)) / (2.0 * h);
      EXPECT_NEAR(gradient[j], slope, 1e-4 * (1.0 + gradient.norm())) << "point " << i << ", coordinate " << j;
      largest = std::max(largest, std::abs(slope));
    }
  }
  EXPECT_GT(largest, 0.1);
}

TEST(GraspObjective, GradientEqualsCentralDifferencesForTheAllegroHand) {
  const robot::Scene scene = test::with_table(test::scene_of(robot::Sphere{0.035}), -0.035);
  expect_gradient({test::allegro(), test::power_synergies().group.box, scene}, 25, 51);
}

TEST(GraspObjective, GradientWithSlidingAndCopiedJointsAndScale) {
  const robot::RobotModel hand = gripper();
  SynergyBox box = test::box(Eigen::VectorXd::Constant(1, -0.2), Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1));
  box.scale[0] = 0.1;
  expect_gradient({hand, box, test::scene_of(robot::Box{Eigen::Vector3d(0.05, 0.05, 0.05)})}, 25, 52);
}

TEST(GraspObjective, HandSurfaceKnowsFingersAndApproach) {
  const HandSurface surface = hand_surface(test::allegro(), Eigen::VectorXd::Zero(16));
  ASSERT_EQ(surface.fingers.size(), 4u);
  for (const Finger& finger : surface.fingers) EXPECT_EQ(finger.joints.size(), 4u);
  EXPECT_NEAR((surface.approach - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-12);
  const HandSurface two = hand_surface(gripper(), Eigen::VectorXd::Zero(1));
  EXPECT_EQ(two.fingers.size(), 2u);
  EXPECT_TRUE(two.moves[2][0]);  // through the joint that copies
}

TEST(GraspObjective, OptimizationLowersTheCostInsideTheBox) {
  const test::Synergies synergies = test::power_synergies();
  const GraspTarget target = make_target(test::scene_of(robot::Sphere{0.035}), "object", 2);
  const HandSurface surface = hand_surface(test::allegro(), synergies.group.box.center);
  GraspObjective objective(test::allegro(), surface, target, synergies.group.box);
  HandSeed seed;
  seed.y = Eigen::Vector3d(-0.3, 0.1, 0.2);
  seed.X_OH.translation() = Eigen::Vector3d(-0.1, 0.02, 0.05);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(objective.size());
  start.tail(3) = seed.y;
  const double before = objective.evaluate(seed, start, nullptr);
  const HandSeed best = optimize_seed(objective, seed, synergies.group.box.half_width, 60);
  EXPECT_TRUE((best.y.cwiseAbs().array() <= synergies.group.box.half_width.array() + 1e-12).all());
  Eigen::VectorXd there = Eigen::VectorXd::Zero(objective.size());
  there.tail(3) = best.y;
  EXPECT_LT(objective.evaluate(best, there, nullptr), 0.8 * before);
  EXPECT_LE(objective.evaluations(), 70);
}

TEST(HandSeed, FacesTheSurfaceClearOfTheTableAndTheBestCostsLeast) {
  const test::Synergies synergies = test::power_synergies();
  const GraspTarget target = make_target(test::with_table(test::scene_of(robot::Sphere{0.05}), -0.05), "object", 2);
  const HandSurface surface = hand_surface(test::allegro(), synergies.group.box.center);
  const SeedSpace space{test::allegro(), surface, target, synergies.group.box};
  GraspObjective objective(test::allegro(), surface, target, synergies.group.box);
  Rng rng = stream(53, "seed");
  const auto cost = [&](const HandSeed& seed) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(objective.size());
    x.tail(3) = seed.y;
    return objective.evaluate(seed, x, nullptr);
  };
  double mean = 0.0;
  double mean_best = 0.0;
  for (int i = 0; i < 50; ++i) {
    const auto seed = draw_seed(space, rng);
    ASSERT_TRUE(seed.has_value());
    const Eigen::Vector3d palm = seed->X_OH * surface.palm_center;
    EXPECT_GT(target.obstacle_distance(palm, 1.0).value, 0.0);
    EXPECT_LT((seed->X_OH.linear() * surface.approach).dot(palm.normalized()), 0.2);  // looks towards the ball
    EXPECT_TRUE((seed->y.cwiseAbs().array() <= synergies.group.box.half_width.array()).all());
    mean += cost(*seed) / 50.0;
    mean_best += cost(*best_seed(space, objective, rng)) / 50.0;
  }
  EXPECT_LT(mean_best, mean);
  robot::Scene buried = test::scene_of(robot::Sphere{0.05});
  buried.bodies.push_back(
      {"sand", Eigen::Isometry3d::Identity(), {{robot::Sphere{1.0}, Eigen::Isometry3d::Identity()}}});
  const GraspTarget unreachable = make_target(buried, "object", 2);
  EXPECT_FALSE(draw_seed({test::allegro(), surface, unreachable, synergies.group.box}, rng).has_value());
}

}  // namespace
}  // namespace opponens::grasp
