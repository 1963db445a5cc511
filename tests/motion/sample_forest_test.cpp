// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/sample_forest.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.hpp"

namespace opponens::motion {
namespace {

Eigen::VectorXd random_vector(int d, Rng& rng) {
  Eigen::VectorXd q(d);
  for (double& x : q) x = rng.uniform(-3.0, 3.0);
  return q;
}

class SampleForestDimension : public ::testing::TestWithParam<int> {};

TEST_P(SampleForestDimension, NearestIsTheBruteForceOne) {
  const int d = GetParam();
  Rng rng = stream(7, "test/forest");
  const Eigen::VectorXd weights = random_vector(d, rng).cwiseAbs().array() + 0.1;
  SampleForest forest(weights);
  std::vector<Eigen::VectorXd> all;
  for (int i = 0; i < 300; ++i) {
    all.push_back(random_vector(d, rng));
    if (i < 3) {
      forest.add_root(all.back());
    } else {
      forest.add(all.back(), static_cast<int>(rng.index(static_cast<std::uint64_t>(i))));
    }
  }
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd q = random_vector(d, rng);
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < 300; ++i) {
      const Eigen::VectorXd difference = all[static_cast<std::size_t>(i)] - q;
      const double squared = difference.dot(weights.cwiseProduct(difference));
      if (squared < least) {
        least = squared;
        best = i;
      }
    }
    const auto nearest = forest.nearest(q);
    ASSERT_EQ(nearest.vertex, best) << "trial " << trial;
    ASSERT_NEAR(nearest.distance, std::sqrt(least), 1e-12 * (1.0 + least));
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, SampleForestDimension, ::testing::Values(1, 2, 3, 4, 5, 16, 22));

TEST(SampleForest, LowestIndexAmongEquals) {
  SampleForest forest(Eigen::Vector2d(1, 1));
  forest.add_root(Eigen::Vector2d(1, 0));
  forest.add_root(Eigen::Vector2d(-1, 0));
  EXPECT_EQ(forest.nearest(Eigen::Vector2d(0, 0)).vertex, 0);
}

TEST(SampleForest, WeightsDecide) {
  SampleForest forest(Eigen::Vector2d(1, 9));
  forest.add_root(Eigen::Vector2d(2, 0));  // distance 2
  forest.add_root(Eigen::Vector2d(0, 1));  // distance 3
  const auto nearest = forest.nearest(Eigen::Vector2d(0, 0));
  EXPECT_EQ(nearest.vertex, 0);
  EXPECT_DOUBLE_EQ(nearest.distance, 2.0);
  EXPECT_DOUBLE_EQ(forest.nearest(Eigen::Vector2d(0, 0.9)).distance, 0.30000000000000004);
}

TEST(SampleForest, RootsAndPaths) {
  SampleForest forest(Eigen::VectorXd::Ones(3));
  const int a = forest.add_root(Eigen::Vector3d(0, 0, 0));
  const int b = forest.add_root(Eigen::Vector3d(9, 9, 9));
  const int c = forest.add(Eigen::Vector3d(8, 9, 9), b);
  const int d = forest.add(Eigen::Vector3d(7, 9, 9), c);
  EXPECT_EQ(forest.root(a), 0);
  EXPECT_EQ(forest.root(d), 1);
  EXPECT_EQ(forest.path_from_root(d), (std::vector<int>{b, c, d}));
  EXPECT_EQ(forest.vertex(c), Eigen::VectorXd(Eigen::Vector3d(8, 9, 9)));
}

TEST(SampleForest, RemovedSubtreeLeavesTheRest) {
  SampleForest forest(Eigen::VectorXd::Ones(1));
  const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  const int root = forest.add_root(at(0));
  const int one = forest.add(at(1), root);
  const int ten = forest.add(at(10), root);
  forest.add(at(2), one);
  const int eleven = forest.add(at(11), ten);
  forest.add(at(12), eleven);
  EXPECT_EQ(forest.remove_subtree(one), 2);
  ASSERT_EQ(forest.size(), 4);
  EXPECT_DOUBLE_EQ(forest.nearest(at(1.9)).distance, 1.9);
  const std::vector<int> path = forest.path_from_root(3);
  ASSERT_EQ(path.size(), 4U);
  EXPECT_DOUBLE_EQ(forest.vertex(path[2])[0], 11.0);
  EXPECT_THROW(forest.remove_subtree(0), std::invalid_argument);
}

TEST(SampleForest, RefusesWhatItCannotHold) {
  EXPECT_THROW(SampleForest(Eigen::Vector2d(1, 0)), std::invalid_argument);
  SampleForest forest(Eigen::Vector2d(1, 1));
  EXPECT_THROW(forest.nearest(Eigen::Vector2d(0, 0)), std::invalid_argument);
  EXPECT_THROW(forest.add_root(Eigen::Vector3d(0, 0, 0)), std::invalid_argument);
  EXPECT_THROW(forest.add_root(Eigen::Vector2d(0, NAN)), std::invalid_argument);
  EXPECT_THROW(forest.add(Eigen::Vector2d(0, 0), 0), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::motion
