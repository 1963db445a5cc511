// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/scene_clearance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/rng.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"

namespace opponens::motion {
namespace {

struct Shelf {
  std::filesystem::path models = std::filesystem::path(OPPONENS_SOURCE_DIR) / "models";
  robot::RobotModel robot{robot::load_robot(models / "ur5_allegro/ur5_allegro_right.yaml")};
  robot::Scene scene = robot::load_scene(models / "scenes/bottle_shelf.yaml");

  Eigen::VectorXd random(Rng& rng) const {
    return Eigen::VectorXd::NullaryExpr(robot.dof(), [&](Eigen::Index j) {
      return rng.uniform(std::max(-1.5, robot.lower()[j]), std::min(1.5, robot.upper()[j]));
    });
  }
};

TEST(SceneClearances, SlopesAreThoseOfCentralDifferences) {
  const Shelf shelf;
  const Clearances clearances = scene_clearances(shelf.robot, shelf.scene, 10.0);
  Rng rng = stream(1, "test/scene_clearance");
  int compared = 0;
  int off = 0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = shelf.random(rng);
    Eigen::MatrixXd slope;
    const Eigen::VectorXd at = clearances(q, &slope);
    ASSERT_EQ(slope.rows(), at.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      constexpr double kStep = 1e-6;
      Eigen::VectorXd moved = q;
      moved[j] += kStep;
      const Eigen::VectorXd above = clearances(moved, nullptr);
      moved[j] -= 2.0 * kStep;
      const Eigen::VectorXd difference = (above - clearances(moved, nullptr)) / (2.0 * kStep);
      compared += static_cast<int>(at.size());
      off += static_cast<int>(((difference - slope.col(j)).array().abs() > 1e-5).count());
    }
  }
  EXPECT_LE(off, compared / 100);  // where the nearest ball or face changes there is no slope
}

TEST(SceneClearances, NeverMoreThanTheTruth) {
  Shelf shelf;
  // The robot's base, which q does not move, stands on it.
  std::erase_if(shelf.scene.bodies, [](const robot::SceneBody& body) { return body.name == "pedestal"; });
  const Clearances clearances = scene_clearances(shelf.robot, shelf.scene, 10.0);
  robot::RobotDescription alone = shelf.robot.description();  // not held against itself
  for (int i = 0; i < static_cast<int>(alone.links.size()); ++i) {
    for (int j = 0; j < i; ++j) alone.allowed_collisions.emplace(j, i);
  }
  const robot::RobotModel model(alone);
  const robot::CollisionChecker checker(model, shelf.scene);
  Rng rng = stream(2, "test/scene_clearance");
  int apart = 0;
  double widest = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = shelf.random(rng);
    const double truth = checker.clearance(q).distance;
    if (truth == 0.0) continue;
    ++apart;
    const double found = clearances(q, nullptr).minCoeff();
    EXPECT_LE(found, truth + 1e-6);
    widest = std::max(widest, truth - found);
  }
  EXPECT_GT(apart, 20);
  EXPECT_LT(widest, 0.08);  // the balls are few, not shapeless
}

TEST(SceneClearances, BeyondReachNothingIsAsked) {
  const Shelf shelf;
  Eigen::MatrixXd slope;
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(shelf.robot.dof());
  const Eigen::VectorXd near = scene_clearances(shelf.robot, shelf.scene, -5.0)(q, &slope);
  EXPECT_TRUE((near.array() == -5.0).all());
  EXPECT_EQ(slope.norm(), 0.0);
}

}  // namespace
}  // namespace opponens::motion
