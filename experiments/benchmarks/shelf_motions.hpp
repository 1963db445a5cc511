// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "robot/robot_model.hpp"
#include "robot/scene.hpp"

namespace opponens::benchmarks {

/// A robot in front of a shelf, with a start and goals as a planner gets them.
struct ShelfProblem {
  robot::RobotModel robot;
  robot::Scene scene;
  Eigen::VectorXd start;               ///< [d] rad, free
  std::vector<Eigen::VectorXd> goals;  ///< [d] rad, free: the open hand around the object to grasp
};

/// The scene's start (its joints taken in the robot's order: arm, then hand) and goals at random palm poses within 0.2 m
/// of the object, found by the arm's inverse kinematics. Throws InputError when the start is not free or no goal is.
ShelfProblem shelf_problem(const std::filesystem::path& robot_yaml, const std::filesystem::path& scene_yaml);

/// A straight motion that a planner asked about.
struct Motion {
  Eigen::VectorXd from;  ///< [d] rad
  Eigen::VectorXd to;    ///< [d] rad
};

constexpr double kMotionResolution = 0.02;  ///< rad, spacing of the configurations that a motion's check asks about

/// Every motion that the multi-goal RRT-Connect (step 0.4 rad) asks about while it solves the problem for the seeds
/// 1, 2, ..., until there are `count` of them.
std::vector<Motion> record_motions(const ShelfProblem& problem, std::size_t count);

/// The configurations of a motion, coarse to fine, in the order in which motion::first_invalid asks: [N x d].
Eigen::MatrixXd configurations_of(const Motion& motion, const Eigen::VectorXd& weights);

}  // namespace opponens::benchmarks
