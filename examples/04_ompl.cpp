// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The planner in an OMPL program: its input is one projection per root, here the box around a hand posture. Usage:
// example_04_ompl MODELS_FOLDER
#include <cmath>
#include <cstdio>

#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>

#include "motion/ompl_planner.hpp"
#include "robot/collision.hpp"
#include "robot/load_robot.hpp"

namespace ob = ompl::base;

int main(int argc, char** argv) {
  if (argc != 2) return std::printf("usage: %s MODELS_FOLDER\n", argv[0]), 2;
  const std::string models = argv[1];
  const opponens::robot::RobotModel robot(opponens::robot::load_robot(models + "/ur5_allegro/ur5_allegro_right.yaml"));
  const auto scene = opponens::robot::load_scene(models + "/scenes/bottle_shelf.yaml");
  const opponens::robot::CollisionChecker checker(robot, scene);

  const auto space = std::make_shared<ob::RealVectorStateSpace>(robot.dof());
  ob::RealVectorBounds bounds(static_cast<unsigned>(robot.dof()));
  bounds.low.assign(robot.lower().begin(), robot.lower().end());
  bounds.high.assign(robot.upper().begin(), robot.upper().end());
  space->setBounds(bounds);
  ompl::geometric::SimpleSetup setup{ob::StateSpacePtr(space)};
  setup.setStateValidityChecker([&](const ob::State* state) {
    const double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    return checker.free(Eigen::Map<const Eigen::VectorXd>(values, robot.dof()));
  });
  setup.getSpaceInformation()->setStateValidityCheckingResolution(0.02 / space->getMaximumExtent());

  ob::ScopedState<> start(space);
  ob::ScopedState<> goal(space);
  for (unsigned i = 0; i < space->getDimension(); ++i) {  // the scene's start, and the arm swung to its other side
    for (std::size_t j = 0; j < scene.start_joints.size(); ++j) {
      if (scene.start_joints[j] == robot.joint_names()[i]) start[i] = scene.start(static_cast<int>(j));
    }
    goal[i] = start[i] + (i == 0 ? 1.5 : 0.0);
  }
  setup.setStartAndGoalStates(start, goal);

  opponens::SynergyBox box;  // two synergies around the start's posture: the flexion of the fingers, and of the thumb
  box.center = Eigen::Map<const Eigen::VectorXd>(&start[static_cast<unsigned>(robot.hand().first)], 16);
  box.scale = Eigen::VectorXd::Ones(16);
  box.axes = Eigen::MatrixXd::Zero(16, 2);
  for (int i = 0; i < 16; ++i) box.axes(i, i < 12 ? 0 : 1) = i < 12 ? 1 / std::sqrt(12.0) : 0.5;
  box.half_width = Eigen::Vector2d(0.8, 0.4);
  const auto project = opponens::motion::box_projection(box, robot.hand(), robot.lower(), robot.upper());

  const auto planner = std::make_shared<opponens::motion::SynPlanner>(setup.getSpaceInformation());
  planner->set_start_projection(project);
  planner->set_goal_projections({project});
  setup.setPlanner(planner);
  return setup.solve(60.0) == ob::PlannerStatus::EXACT_SOLUTION ? 0 : 1;
}
