// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "shelf_motions.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "core/require.hpp"
#include "core/rng.hpp"
#include "motion/edge_check.hpp"
#include "motion/goal_configurations.hpp"
#include "motion/syn_planner.hpp"
#include "robot/collision.hpp"
#include "robot/inverse_kinematics.hpp"
#include "robot/load_robot.hpp"

namespace opponens::benchmarks {
namespace {

constexpr int kGoals = 8;
constexpr int kTries = 20000;

/// A palm with the object's axis in front of it, from a random side, turned about its normal.
Eigen::Isometry3d random_palm(const Eigen::Isometry3d& X_WO, Rng& rng) {
  const double side = rng.uniform(-std::numbers::pi, std::numbers::pi);
  const double tilt = rng.uniform(-0.4, 0.4);
  const double roll = rng.uniform(-std::numbers::pi, std::numbers::pi);
  Eigen::Isometry3d X_OH = Eigen::Isometry3d::Identity();
  X_OH.rotate(Eigen::AngleAxisd(side, Eigen::Vector3d::UnitZ()));
  X_OH.rotate(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()));
  X_OH.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  const double back = rng.uniform(0.05, 0.2);
  X_OH.pretranslate(Eigen::Vector3d(0, 0, rng.uniform(0.05, 0.15)) - back * X_OH.linear().col(0));
  return X_WO * X_OH;
}

std::vector<Eigen::VectorXd> free_goals(const robot::RobotModel& robot, const robot::Scene& scene,
                                        const robot::CollisionChecker& checker, const Eigen::VectorXd& start) {
  const robot::InverseKinematics kinematics = robot::make_inverse_kinematics(robot);
  const Eigen::VectorXd open_hand = start.segment(robot.hand().first, robot.hand().count);
  const Eigen::Isometry3d X_WO = scene.body(scene.object).X_WB;
  Rng rng = stream(1, "shelf goals");
  std::vector<Eigen::VectorXd> goals;
  for (int i = 0; i < kTries && static_cast<int>(goals.size()) < kGoals; ++i) {
    const Eigen::Isometry3d X_RH = scene.X_WR.inverse() * random_palm(X_WO, rng);
    const auto solutions = kinematics(X_RH, {});
    if (!solutions) continue;
    for (const Eigen::VectorXd& q_arm : *solutions) {
      const Eigen::VectorXd q = motion::join(robot, q_arm, open_hand);
      if (!checker.free(q)) continue;
      goals.push_back(q);
      break;
    }
  }
  return goals;
}

}  // namespace

ShelfProblem shelf_problem(const std::filesystem::path& robot_yaml, const std::filesystem::path& scene_yaml) {
  robot::RobotModel robot(robot::load_robot(robot_yaml));
  robot::Scene scene = robot::load_scene(scene_yaml);
  if (scene.start.size() != robot.dof()) throw InputError(scene_yaml.string() + ": start has another number of joints");
  const Eigen::VectorXd start = scene.start;
  const robot::CollisionChecker checker(robot, scene);
  if (!checker.free(start)) throw InputError(scene_yaml.string() + ": the start is not free");
  std::vector<Eigen::VectorXd> goals = free_goals(robot, scene, checker, start);
  if (goals.empty()) throw InputError(scene_yaml.string() + ": no goal is free");
  return {std::move(robot), std::move(scene), start, std::move(goals)};
}

std::vector<Motion> record_motions(const ShelfProblem& problem, std::size_t count) {
  const robot::RobotModel& robot = problem.robot;
  const robot::CollisionChecker checker(robot, problem.scene);
  std::vector<Motion> motions;
  motion::World world = motion::make_world(checker, robot, kMotionResolution);
  world.confirm = {};
  world.first_invalid = [inner = world.first_invalid, &motions](const auto& from, const auto& to, std::int64_t& checks) {
    motions.push_back({from, to});
    return inner(from, to, checks);
  };
  motion::PlanQuery query{{problem.start, {}, -1}, {}, robot.joint_names(), robot.lower(), robot.upper(),
                          robot.weights()};
  for (std::size_t i = 0; i < problem.goals.size(); ++i) {
    query.goals.push_back({problem.goals[i], {}, static_cast<int>(i)});
  }
  motion::PlannerSettings settings;
  settings.variant = motion::Variant::rrtconnect;
  settings.interrupted = [&] { return motions.size() >= count; };
  for (std::uint64_t seed = 1; motions.size() < count; ++seed) motion::plan(query, world, settings, seed);
  motions.resize(count);
  return motions;
}

Eigen::MatrixXd configurations_of(const Motion& motion, const Eigen::VectorXd& weights) {
  std::vector<Eigen::VectorXd> asked;
  std::int64_t checks = 0;
  motion::first_invalid(
      motion.from, motion.to,
      [&](const Eigen::VectorXd& q) {
        asked.push_back(q);
        return true;
      },
      weights, kMotionResolution, checks);
  Eigen::MatrixXd configurations(static_cast<Eigen::Index>(asked.size()), motion.from.size());
  for (std::size_t i = 0; i < asked.size(); ++i) configurations.row(static_cast<Eigen::Index>(i)) = asked[i];
  return configurations;
}

}  // namespace opponens::benchmarks
