// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/syn_extend.hpp"

#include <gtest/gtest.h>

#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

class SynExtend : public ::testing::Test {
 protected:
  Graph graph(const Eigen::Vector4d& root, double h2 = 0.0) const {
    Graph result{SampleForest(toy.weights), {box_projection(line_box(h2), toy.hand, toy.lower, toy.upper)}};
    result.forest.add_root(root);
    return result;
  }
  ToyWorld toy;
  SearchCounts counts;
  StepSettings settings{0.4, 1e-9};
};

TEST_F(SynExtend, StepGoesTowardsTheProjection) {
  Graph g = graph({0, 0, 0, 0});
  const auto extension = syn_extend(g, Eigen::Vector4d(2, 0, 0, 1), true, settings, toy.world(), counts);
  ASSERT_EQ(extension.advance, Advance::advanced);
  // h2 = 1 is off the line h2 = 0: the step is along x alone.
  EXPECT_TRUE(g.forest.vertex(extension.vertex).isApprox(Eigen::Vector4d(0.4, 0, 0, 0), 1e-15));
  EXPECT_NEAR(extension.gap, std::sqrt(5.0), 1e-15);
  EXPECT_EQ(counts.extends, 1);
  EXPECT_EQ(counts.extends_grown, 1);
  EXPECT_EQ(counts.collision_checks, 20);  // 0.4 at a spacing of 0.02
}

TEST_F(SynExtend, FullSpaceStepGoesStraight) {
  Graph g = graph({0, 0, 0, 0});
  const auto extension = syn_extend(g, Eigen::Vector4d(1.2, 0, 0, 0.9), false, settings, toy.world(), counts);
  EXPECT_TRUE(g.forest.vertex(extension.vertex).isApprox(Eigen::Vector4d(0.32, 0, 0, 0.24), 1e-14));
}

TEST_F(SynExtend, ShortProjectedStepEndsAtTheProjection) {
  Graph g = graph({0, 0, 0, 0});
  const auto extension = syn_extend(g, Eigen::Vector4d(0.1, 0, 0, 1), true, settings, toy.world(), counts);
  ASSERT_EQ(extension.advance, Advance::advanced);  // the projection was reached, not the target
  EXPECT_EQ(g.forest.vertex(extension.vertex), Eigen::VectorXd(Eigen::Vector4d(0.1, 0, 0, 0)));
}

TEST_F(SynExtend, TargetWithinEpsilonIsTakenAsItIs) {  // line 2
  Graph g = graph({0, 0, 0, 0});
  const Eigen::VectorXd target = Eigen::Vector4d(0.1, 0.1, 0, 0.3);
  const auto extension = syn_extend(g, target, true, settings, toy.world(), counts);
  EXPECT_EQ(extension.advance, Advance::reached);
  EXPECT_EQ(g.forest.vertex(extension.vertex), target);
}

TEST_F(SynExtend, TargetThatIsAVertexIsReachedWithoutANewOne) {
  Graph g = graph({0, 0, 0, 0});
  const auto extension = syn_extend(g, Eigen::Vector4d(0, 0, 0, 0), true, settings, toy.world(), counts);
  EXPECT_EQ(extension.advance, Advance::reached);
  EXPECT_EQ(extension.vertex, 0);
  EXPECT_EQ(g.forest.size(), 1);
  EXPECT_EQ(counts.extends_grown, 0);
}

TEST_F(SynExtend, ProjectionOnTheTreeItselfIsNoStep) {  // line 5 would divide by zero
  Graph g = graph({0, 0, 0, 0});
  const auto extension = syn_extend(g, Eigen::Vector4d(0, 0, 0, 1), true, settings, toy.world(), counts);
  EXPECT_EQ(extension.advance, Advance::stalled);
  EXPECT_FALSE(extension.grew());
  EXPECT_EQ(g.forest.size(), 1);
  EXPECT_EQ(counts.collision_checks, 0);
}

TEST_F(SynExtend, CollisionGivesTheEmptySet) {
  toy.obstacles.push_back({{0.15, -1, -1, -1}, {0.25, 1, 1, 1}});
  Graph g = graph({0, 0, 0, 0});
  const auto extension = syn_extend(g, Eigen::Vector4d(2, 0, 0, 0), true, settings, toy.world(), counts);
  EXPECT_EQ(extension.advance, Advance::blocked);
  EXPECT_EQ(g.forest.size(), 1);
}

TEST_F(SynExtend, TheNearestVertexsRootDecidesTheBox) {
  Graph g = graph({0, 0, 0, 0});
  g.forest.add_root(Eigen::Vector4d(2, 2, 0, 0.5));
  g.projections.push_back(box_projection(line_box(0.5), toy.hand, toy.lower, toy.upper));
  const auto extension = syn_extend(g, Eigen::Vector4d(2, 1, 0, 1), true, settings, toy.world(), counts);
  EXPECT_EQ(g.forest.root(extension.vertex), 1);
  EXPECT_TRUE(g.forest.vertex(extension.vertex).isApprox(Eigen::Vector4d(2, 1.6, 0, 0.5), 1e-14));
}

TEST_F(SynExtend, ProjectionKeepsTheArmAndClipsTheHand) {
  SynergyBox box = line_box(0.0);
  box.center[1] = 1.5;  // sticks out of the limit h2 <= 1
  const Projection project = box_projection(box, toy.hand, toy.lower, toy.upper);
  EXPECT_EQ(project(Eigen::Vector4d(1.7, -1.9, 0.95, -1)), Eigen::VectorXd(Eigen::Vector4d(1.7, -1.9, 0.8, 1)));
  box.center = Eigen::Vector3d::Zero();
  EXPECT_THROW(box_projection(box, toy.hand, toy.lower, toy.upper), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::motion
