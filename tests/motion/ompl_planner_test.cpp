// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/ompl_planner.hpp"

#include <gtest/gtest.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/util/Console.h>

#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// An OMPL program as others write it: arm and hand in a compound space.
class OmplPlanner : public ::testing::Test {
 protected:
  OmplPlanner() {
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    toy.add_wall(0.5, 0.7);
    const auto arm = std::make_shared<ob::RealVectorStateSpace>(2);
    arm->setBounds(-2, 2);
    const auto hand = std::make_shared<ob::RealVectorStateSpace>(2);
    hand->setBounds(-1, 1);
    space = arm + hand;
    space->setup();
    setup = std::make_unique<og::SimpleSetup>(space);
    setup->setStateValidityChecker([this](const ob::State* state) {
      std::vector<double> q;
      space->copyToReals(q, state);
      ++evaluated;
      return toy.valid(Eigen::Map<const Eigen::VectorXd>(q.data(), 4));
    });
    setup->getSpaceInformation()->setStateValidityCheckingResolution(0.002);
    planner = std::make_shared<SynPlanner>(setup->getSpaceInformation());
    planner->set_start_projection(box_projection(line_box(0), toy.hand, toy.lower, toy.upper));
    setup->setPlanner(planner);
  }
  ob::ScopedState<> state(const std::vector<double>& q) const {
    ob::ScopedState<> result(space);
    space->copyFromReals(result.get(), q);
    return result;
  }
  void set_query(const std::vector<double>& start = {-1, -1, 0.2, 0}) {
    setup->setStartState(state(start));
    const auto goals = std::make_shared<ob::GoalStates>(setup->getSpaceInformation());
    goals->addState(state({1, -1, -0.3, 0.25}));
    goals->addState(state({1.5, -1.5, 0, 0.6}));
    setup->setGoal(goals);
    planner->set_goal_projections({box_projection(line_box(0.25), toy.hand, toy.lower, toy.upper),
                                   box_projection(line_box(0.6), toy.hand, toy.lower, toy.upper)});
  }
  ToyWorld toy;
  std::int64_t evaluated = 0;
  ob::StateSpacePtr space;
  std::unique_ptr<og::SimpleSetup> setup;
  std::shared_ptr<SynPlanner> planner;
};

TEST_F(OmplPlanner, SolvesInASimpleSetup) {
  set_query();
  ASSERT_EQ(setup->solve(60.0), ob::PlannerStatus::EXACT_SOLUTION);
  EXPECT_TRUE(setup->haveExactSolutionPath());
  EXPECT_TRUE(setup->getSolutionPath().check());
  EXPECT_EQ(setup->getSolutionPath().getStateCount(),
            static_cast<std::size_t>(planner->result().path.waypoints.rows()));
  EXPECT_EQ(setup->getSolutionPlannerName(), "SynPlanner");
}

TEST_F(OmplPlanner, IsTheSameSearchAsTheFreeFunction) {
  // Same world through both doors: the paths agree where the spacing of the checks does not decide.
  toy.obstacles.clear();
  set_query();
  ASSERT_EQ(setup->solve(60.0), ob::PlannerStatus::EXACT_SOLUTION);
  const PlanResult direct = plan_toy(
      toy, {-1, -1, 0.2, 0},
      {{Eigen::Vector4d(1, -1, -0.3, 0.25), line_box(0.25), 0}, {Eigen::Vector4d(1.5, -1.5, 0, 0.6), line_box(0.6), 1}},
      {}, 1);
  EXPECT_EQ(planner->result().path.waypoints, direct.path.waypoints);
  EXPECT_EQ(planner->result().goal, direct.goal);
}

TEST_F(OmplPlanner, SameSeedSamePathWhateverOmplsSeed) {
  set_query();
  ASSERT_TRUE(setup->solve(60.0));
  const Eigen::MatrixXd first = planner->result().path.waypoints;
  const std::int64_t checks = planner->result().collision_checks;
  setup->clear();
  evaluated = 0;
  ASSERT_TRUE(setup->solve(60.0));
  EXPECT_EQ(planner->result().path.waypoints, first);
  EXPECT_EQ(planner->result().collision_checks, checks);
  EXPECT_EQ(evaluated, checks);
  planner->set_seed(99);
  setup->clear();
  ASSERT_TRUE(setup->solve(60.0));
  EXPECT_TRUE(planner->result().path.waypoints.rows() != first.rows() || planner->result().path.waypoints != first);
}

TEST_F(OmplPlanner, PlannerDataHoldsBothGraphsAndTheWay) {
  set_query();
  ASSERT_TRUE(setup->solve(60.0));
  ob::PlannerData data(setup->getSpaceInformation());
  planner->getPlannerData(data);
  EXPECT_EQ(data.numStartVertices(), 1U);
  EXPECT_EQ(data.numGoalVertices(), 2U);
  EXPECT_EQ(data.numEdges(), data.numVertices() - 3 + 1) << "trees, and where they met";
  // Along the edges from the start every waypoint of the path is met.
  std::vector<unsigned> reached{data.getStartIndex(0)};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    std::vector<unsigned> next;
    data.getEdges(reached[i], next);
    reached.insert(reached.end(), next.begin(), next.end());
  }
  bool goal = false;
  for (const unsigned i : reached) goal = goal || data.isGoalVertex(i);
  EXPECT_TRUE(goal);
  planner->clear();
  EXPECT_TRUE(space->equalStates(data.getStartVertex(0).getState(), state({-1, -1, 0.2, 0}).get()))
      << "data owns its states";
  ob::PlannerData none(setup->getSpaceInformation());
  planner->getPlannerData(none);
  EXPECT_EQ(none.numVertices(), 0U);
}

TEST_F(OmplPlanner, ParametersAndProgressGoByName) {
  set_query();
  EXPECT_TRUE(planner->params().setParam("range", "0.25"));
  EXPECT_DOUBLE_EQ(planner->getRange(), 0.25);
  EXPECT_TRUE(planner->params().setParam("variant", "rrtconnect"));
  std::string value;
  EXPECT_TRUE(planner->params().getParam("variant", value));
  EXPECT_EQ(value, "rrtconnect");
  EXPECT_THROW(planner->params().setParam("variant", "fastest"), ompl::Exception);
  EXPECT_TRUE(planner->params().setParam("max_iterations", "7"));
  EXPECT_EQ(setup->solve(60.0), ob::PlannerStatus::TIMEOUT);
  EXPECT_EQ(planner->result().iterations, 7);
  const auto& progress = planner->getPlannerProgressProperties();
  EXPECT_EQ(progress.at("iterations INTEGER")(), "7");
  EXPECT_EQ(progress.at("collision checks INTEGER")(), std::to_string(planner->result().collision_checks));
  EXPECT_GT(std::stoi(progress.at("states INTEGER")()), 3);
}

TEST_F(OmplPlanner, StatusesAreOmpls) {
  set_query({0, 0, 0, 0});
  EXPECT_EQ(setup->solve(1.0), ob::PlannerStatus::INVALID_START);
  set_query();
  EXPECT_EQ(setup->solve(0.0), ob::PlannerStatus::TIMEOUT);
  EXPECT_EQ(planner->result().iterations, 0);
  const auto inside_the_wall = std::make_shared<ob::GoalStates>(setup->getSpaceInformation());
  inside_the_wall->addState(state({0, 0, 0, 0}));
  setup->setGoal(inside_the_wall);
  planner->set_goal_projections({});
  EXPECT_EQ(setup->solve(1.0), ob::PlannerStatus::INVALID_GOAL);
}

TEST_F(OmplPlanner, RefusesSpacesThatAreNoBoxes) {
  const auto circle = std::make_shared<ob::SO2StateSpace>();
  og::SimpleSetup other{ob::StateSpacePtr(circle)};
  other.setStateValidityChecker([](const ob::State*) { return true; });
  other.setPlanner(std::make_shared<SynPlanner>(other.getSpaceInformation()));
  ob::ScopedState<> a(ob::StateSpacePtr{circle});
  ob::ScopedState<> b(ob::StateSpacePtr{circle});
  a[0] = 0.0;
  b[0] = 1.0;
  other.setStartAndGoalStates(a, b);
  EXPECT_THROW(other.solve(1.0), ompl::Exception);
}

}  // namespace
}  // namespace opponens::motion
