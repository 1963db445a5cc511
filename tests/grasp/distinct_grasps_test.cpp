// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/distinct_grasps.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace opponens::grasp {
namespace {

Grasp at(double x, double turn, double joint, std::optional<double> epsilon) {
  Grasp grasp;
  grasp.X_OH = Eigen::Translation3d(x, 0, 0) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  grasp.q_grasp = Eigen::Vector2d(0.1, joint);
  grasp.quality.epsilon = epsilon;
  return grasp;
}

using Indices = std::vector<std::size_t>;
constexpr GraspDistances kDistances{0.01, 0.2, 0.3};

TEST(DistinctGrasps, OneWhenNearInAllThree) {
  const Grasp grasp = at(0, 0, 0, 1.0);
  EXPECT_TRUE(same_grasp(grasp, at(0.009, 0.19, 0.29, 1.0), kDistances));
  EXPECT_FALSE(same_grasp(grasp, at(0.011, 0.0, 0.0, 1.0), kDistances));
  EXPECT_FALSE(same_grasp(grasp, at(0.0, 0.21, 0.0, 1.0), kDistances));
  EXPECT_FALSE(same_grasp(grasp, at(0.0, -0.21, 0.0, 1.0), kDistances));
  EXPECT_FALSE(same_grasp(grasp, at(0.0, 0.0, -0.31, 1.0), kDistances));
  EXPECT_FALSE(same_grasp(grasp, grasp, {0.0, 0.2, 0.3}));  // no distance is less than none
}

TEST(DistinctGrasps, BestFirstAndEachDifferentFromTheBetterOnes) {
  const std::vector<Grasp> grasps{at(0.00, 0, 0, 0.1), at(0.05, 0, 0, 0.3), at(0.055, 0, 0, 0.2), at(0.1, 0, 0, 0.25),
                                  at(0.10, 0, 1, 0.2)};
  EXPECT_EQ(distinct_grasps(grasps, 10, kDistances), (Indices{1, 3, 4, 0}));
  EXPECT_EQ(distinct_grasps(grasps, 2, kDistances), (Indices{1, 3}));
  EXPECT_TRUE(distinct_grasps(grasps, 0, kDistances).empty());
  EXPECT_TRUE(distinct_grasps({}, 5, kDistances).empty());
}

/// A repetition is measured against what is taken, so that a chain of near ones does not end with one.
TEST(DistinctGrasps, AChainKeepsEveryOther) {
  const std::vector<Grasp> grasps{at(0, 0, 0, 0.5), at(0.008, 0, 0, 0.4), at(0.016, 0, 0, 0.3), at(0.024, 0, 0, 0.2)};
  EXPECT_EQ(distinct_grasps(grasps, 10, kDistances), (Indices{0, 2}));
}

TEST(DistinctGrasps, EqualOnesInOrderAndUnknownOnesLast) {
  const std::vector<Grasp> grasps{at(0, 0, 0, std::nullopt), at(0.1, 0, 0, -0.5), at(0.2, 0, 0, 0.1),
                                  at(0.3, 0, 0, 0.1)};
  EXPECT_EQ(distinct_grasps(grasps, 10, kDistances), (Indices{2, 3, 1, 0}));
}

TEST(DistinctGrasps, BrokenContractsThrow) {
  const std::vector<Grasp> grasps{at(0, 0, 0, 0.1)};
  EXPECT_THROW(distinct_grasps(grasps, -1, kDistances), std::invalid_argument);
  EXPECT_THROW(distinct_grasps(grasps, 1, {-0.1, 0.2, 0.3}), std::invalid_argument);
  EXPECT_THROW(distinct_grasps(grasps, 1, {0.1, std::numeric_limits<double>::infinity(), 0.3}), std::invalid_argument);
  Grasp other = grasps[0];
  other.q_grasp.resize(1);
  EXPECT_THROW(same_grasp(grasps[0], other, kDistances), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
