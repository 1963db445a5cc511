// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/synergy_box.hpp"
#include "motion/joint_metric.hpp"
#include "tests/motion/toy_world.hpp"

namespace opponens::motion {
namespace {

Graph rooted(const ToyWorld& toy, const Eigen::Vector4d& root, double h2) {
  Graph graph{SampleForest(toy.weights), {box_projection(line_box(h2), toy.hand, toy.lower, toy.upper)}};
  graph.forest.add_root(root);
  return graph;
}

/// Algorithms 3 and 4 exactly as printed, in a world without obstacles, for at most `cap` passes of SYNCONNECT's loop.
/// Returns the passes made until the graphs met, or cap.
int printed_syn_connect(Graph& a, Graph& b, double epsilon, int cap) {
  Graph* growing = &b;
  Graph* other = &a;
  Eigen::VectorXd q_new = a.forest.vertex(a.forest.size() - 1);
  for (int pass = 0; pass < cap; ++pass) {
    SampleForest& forest = growing->forest;
    const auto near = forest.nearest(q_new);
    const Eigen::VectorXd q_near = forest.vertex(near.vertex);
    if (near.distance <= epsilon) return pass;  // line 2 of SYNEXTEND: q_new is then in both graphs
    const Eigen::VectorXd q_proj = growing->projections.front()(q_new);
    const double factor = std::min(epsilon / distance(forest.weights(), q_proj, q_near), 1.0);
    q_new = q_near + factor * (q_proj - q_near);
    forest.add(q_new, near.vertex);
    std::swap(growing, other);
  }
  return cap;
}

constexpr double kEpsilon = 0.4;

TEST(SynConnect, PrintedRuleMeetsWhenTheBoxesAreNear) {
  const ToyWorld toy;
  Graph a = rooted(toy, {-1, 0, 0, 0}, 0.0);
  Graph b = rooted(toy, {1, 0, 0, 0.3}, 0.3);
  EXPECT_LT(printed_syn_connect(a, b, kEpsilon, 5000), 10);
}

TEST(SynConnect, PrintedRuleAlternatesForEverBetweenFarBoxesAndOursEnds) {
  const ToyWorld toy;
  const auto graphs = [&] { return std::pair(rooted(toy, {-1, 0, 0, 0}, 0.0), rooted(toy, {1, 0, 0, 0.9}, 0.9)); };
  auto [printed_a, printed_b] = graphs();
  EXPECT_EQ(printed_syn_connect(printed_a, printed_b, kEpsilon, 5000), 5000);
  // It is no slow progress: from the tenth pass on the same two configurations come again and again.
  const SampleForest& forest = printed_a.forest;
  ASSERT_GT(forest.size(), 2000);
  for (int i = 20; i < forest.size(); ++i) ASSERT_LT(distance(toy.weights, forest.vertex(i), forest.vertex(20)), 1e-9);

  auto [a, b] = graphs();
  SearchCounts counts;
  const auto bridge = syn_connect(0, a, b, {kEpsilon, 1e-9}, toy.world(), counts);
  ASSERT_TRUE(bridge);  // by the straight steps of the fallback
  EXPECT_EQ(a.forest.vertex(bridge->vertex_a), b.forest.vertex(bridge->vertex_b));
  EXPECT_LT(counts.extends, 30);
}

TEST(SynConnect, EndsWithoutABridgeWhenAWallKeepsTheBoxesApart) {
  ToyWorld toy;
  toy.obstacles.push_back({{-3, -3, -2, 0.4}, {3, 3, 2, 0.5}});  // across the whole space, between the boxes
  Graph a = rooted(toy, {-1, 0, 0, 0}, 0.0);
  Graph b = rooted(toy, {1, 0, 0, 0.9}, 0.9);
  SearchCounts counts;
  EXPECT_FALSE(syn_connect(0, a, b, {kEpsilon, 1e-9}, toy.world(), counts));
  EXPECT_LT(counts.extends, 30);
}

TEST(SynConnect, BridgeNamesTheRightGraphWhicheverGrewLast) {
  const ToyWorld toy;
  for (const double x : {0.3, 0.7, 1.1, 1.5, 1.9}) {  // the graphs meet after an odd or even number of extensions
    Graph a = rooted(toy, {-1, 0, 0, 0}, 0.0);
    Graph b = rooted(toy, {x, 0.5, 0, 0.2}, 0.2);
    SearchCounts counts;
    const auto bridge = syn_connect(0, a, b, {kEpsilon, 1e-9}, toy.world(), counts);
    ASSERT_TRUE(bridge);
    EXPECT_EQ(a.forest.vertex(bridge->vertex_a), b.forest.vertex(bridge->vertex_b));
    EXPECT_GT(a.forest.size(), 1) << "both graphs grow";
    EXPECT_GT(b.forest.size(), 1) << "both graphs grow";
  }
}

TEST(SynConnect, BothTreesStayInTheirBoxesOnTheWay) {
  const ToyWorld toy;
  Graph a = rooted(toy, {-1.5, 0, 0.5, 0}, 0.0);
  Graph b = rooted(toy, {1.5, 1, -0.5, 0.3}, 0.3);
  SearchCounts counts;
  const auto bridge = syn_connect(0, a, b, {kEpsilon, 1e-9}, toy.world(), counts);
  ASSERT_TRUE(bridge);
  const auto outside = [](const Graph& graph, double h2) {
    int count = 0;
    for (int i = 0; i < graph.forest.size(); ++i) {
      const Eigen::VectorXd q = graph.forest.vertex(i);
      if (std::abs(q[3] - h2) > 1e-12 || !analysis::contains(line_box(h2), q.tail(2))) ++count;
    }
    return count;
  };
  EXPECT_LE(outside(a, 0.0) + outside(b, 0.3), 1);  // line 2 relaxes the guideline for the last step alone
}

TEST(StraightConnect, GoesStraightAndStopsAtAnObstacle) {
  ToyWorld toy;
  Graph a = rooted(toy, {-1, 0, 0, 0}, 0.0);
  Graph b = rooted(toy, {1, 0, 0, 0.9}, 0.9);
  SearchCounts counts;
  ASSERT_TRUE(straight_connect(0, a, b, {kEpsilon, 1e-9}, toy.world(), counts));
  EXPECT_EQ(counts.extends, 6);  // |(2, 0.9)| = 2.19 in steps of 0.4
  EXPECT_EQ(a.forest.size(), 1);
  toy.add_wall(2.5, 2.6);
  Graph c = rooted(toy, {1, 0, 0, 0.9}, 0.9);
  EXPECT_FALSE(straight_connect(0, a, c, {kEpsilon, 1e-9}, toy.world(), counts));
}

}  // namespace
}  // namespace opponens::motion
