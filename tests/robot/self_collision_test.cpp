// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/self_collision.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

#include "robot/link_pairs.hpp"
#include "robot_test.hpp"

namespace opponens::robot {
namespace {

constexpr double kMeets = 0.25;  ///< share of the slider's range at which its cube meets the wall

/// A base, a slider along x in [0, 1] with a cube that meets the wall for x < kMeets, a part two joints on that
/// overlaps the slider's cube, and a far body that nothing reaches. Links: base 0, slider 1, hinge 2, wall 3, overlap
/// 4, far 5.
RobotDescription slider() {
  RobotDescription robot;
  robot.name = "slider";
  robot.palm_link = "base";
  const auto box = [](double length, double x) {
    return std::vector<Geometry>{{Box{Eigen::Vector3d(length, 0.1, 0.1)}, at(x, 0, 0)}};
  };
  const auto add = [&](const std::string& name, int parent, JointType type, const std::vector<Geometry>& shape) {
    const int joint = static_cast<int>(robot.joints.size());
    robot.joints.push_back({name + "_joint",
                            type,
                            parent,
                            static_cast<int>(robot.links.size()),
                            Eigen::Isometry3d::Identity(),
                            Eigen::Vector3d::UnitX(),
                            0.0,
                            1.0,
                            1.0,
                            {},
                            {},
                            {}});
    robot.links.push_back({name, joint, shape});
    if (type != JointType::fixed) robot.hand_joints.push_back(name + "_joint");
  };
  robot.links.push_back({"base", -1, {}});
  add("slider", 0, JointType::prismatic, box(0.1, 0.0));
  add("hinge", 1, JointType::revolute, {});
  add("wall", 0, JointType::fixed, box(2.0, kMeets - 1.05));
  add("overlap", 2, JointType::revolute, box(0.1, 0.05));
  add("far", 0, JointType::fixed, box(0.1, -20.0));
  robot.weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(robot.hand_joints.size()));
  return robot;
}

const LinkPairHits& pair_of(const SelfCollisionSamples& samples, int first, int second) {
  for (const LinkPairHits& pair : samples.pairs) {
    if (pair.first == first && pair.second == second) return pair;
  }
  throw std::out_of_range("no such pair");
}

/// Whether a count is one that a probability gives but once in 10,000 times.
bool unlikely(int hits, int samples, double probability) {
  const boost::math::binomial_distribution<double> law(samples, probability);
  return boost::math::cdf(law, hits) < 5e-5 || boost::math::cdf(boost::math::complement(law, hits - 1)) < 5e-5;
}

/// Null distribution: binomial, since the slider's position is uniform in [0, 1]. False-alarm rate 1e-4.
TEST(SelfCollision, SharesAreThoseOfTheGeometry) {
  RobotDescription description = slider();
  allow_adjacent(description);
  Rng rng(5);
  int calls = 0;
  const int samples = 4000;
  const SelfCollisionSamples result = sample_self_collisions(
      RobotModel(description), samples, [&](std::size_t, std::size_t) { ++calls; }, rng);
  EXPECT_EQ(calls, samples);
  EXPECT_EQ(result.pairs.size(), 6u) << "of four links with geometry";
  const LinkPairHits& wall = pair_of(result, 1, 3);
  EXPECT_FALSE(unlikely(wall.hits, samples, kMeets)) << wall.hits;
  EXPECT_TRUE(unlikely(wall.hits, samples, kMeets + 0.05)) << "a wrong share must be rejected";
  EXPECT_TRUE(wall.at_rest);
  EXPECT_EQ(pair_of(result, 1, 4).hits, samples);
  EXPECT_EQ(pair_of(result, 1, 5).hits, 0);
  EXPECT_TRUE(pair_of(result, 3, 5).adjacent) << "one rigid body";
  EXPECT_EQ(result.colliding, samples) << "the overlapping pair is not allowed yet";

  const AllowedSuggestion suggestion = suggest_allowed(result);
  ASSERT_EQ(suggestion.always.size(), 1u);
  EXPECT_EQ(suggestion.always[0].second, 4);
  ASSERT_EQ(suggestion.at_rest.size(), 2u) << "slider and overlap with the wall";
  EXPECT_EQ(suggestion.never.size(), 2u);
  EXPECT_TRUE(suggestion.often.empty());
}

TEST(SelfCollision, AllowedPairsDoNotCountAndEqualSeedsGiveEqualCounts) {
  RobotDescription description = slider();
  allow_adjacent(description);
  description.allowed_collisions.emplace(1, 4);
  description.allowed_collisions.emplace(3, 4);
  Rng one(5);
  Rng two(5);
  const RobotModel model(description);
  const auto first = sample_self_collisions(model, 500, {}, one);
  const auto second = sample_self_collisions(model, 500, {}, two);
  EXPECT_EQ(first.colliding, pair_of(first, 1, 3).hits);
  EXPECT_GT(first.colliding, 0);
  EXPECT_EQ(first.colliding, second.colliding);
  EXPECT_TRUE(suggest_allowed(first).always.empty()) << "they are allowed already";
}

TEST(SelfCollision, BoundOfWhatNeverHappened) {
  for (const int samples : {1, 10, 1000, 1000000}) {
    EXPECT_NEAR(std::pow(1.0 - never_bound(samples), samples), 0.05, 1e-9) << samples;
  }
  EXPECT_NEAR(never_bound(1000), 0.0029912, 1e-6) << "about 3 / n";
  EXPECT_THROW(never_bound(0), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::robot
