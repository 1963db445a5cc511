// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/sample_forest.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.hpp"
#include "motion/block_minima.hpp"
#include "motion/nearest_filter.hpp"

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

/// What the two scans must agree with, bit for bit: one scan in double precision, in the documented order of sums.
SampleForest::Nearest one_scan(const SampleForest& forest, const Eigen::VectorXd& q) {
  double best = INFINITY;
  int nearest = 0;
  for (int i = 0; i < forest.size(); ++i) {
    double lanes[4] = {0.0, 0.0, 0.0, 0.0};
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double difference = forest.vertex(i)[j] - q[j];
      lanes[j % 4] += forest.weights()[j] * difference * difference;
    }
    const double squared = (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
    if (squared < best) {
      best = squared;
      nearest = i;
    }
  }
  return {nearest, std::sqrt(best)};
}

TEST_P(SampleForestDimension, SinglePrecisionDecidesNothing) {
  // Vertices nearer to each other than single precision can tell, on a grid (exact ties), and far from the origin.
  const int d = GetParam();
  Rng rng = stream(8, "test/forest");
  const Eigen::VectorXd weights = random_vector(d, rng).cwiseAbs().array() + 0.1;
  for (const double scale : {1.0, 1e-9, 1e6, 1e11, 1e14}) {
    for (const double offset : {0.0, 1e5}) {
      SampleForest forest(weights);
      const auto draw = [&] {
        Eigen::VectorXd q = random_vector(d, rng);
        if (rng.uniform() < 0.5) q = q.array().round().matrix();
        return Eigen::VectorXd(scale * q.array() + offset);
      };
      forest.add_root(draw());
      for (int i = 1; i < 200; ++i) forest.add(draw(), static_cast<int>(rng.index(static_cast<std::uint64_t>(i))));
      for (int trial = 0; trial < 100; ++trial) {
        const Eigen::VectorXd q = trial % 3 == 0 ? Eigen::VectorXd(forest.vertex(trial)) : draw();
        const auto got = forest.nearest(q);
        const auto expected = one_scan(forest, q);
        ASSERT_EQ(got.vertex, expected.vertex) << scale << " " << offset;
        ASSERT_EQ(got.distance, expected.distance);
      }
      forest.remove_subtree(50);
      const Eigen::VectorXd q = draw();
      ASSERT_EQ(forest.nearest(q).vertex, one_scan(forest, q).vertex) << "the copy follows a removal";
    }
  }
}

TEST(NearestFilter, LeavesOutNearlyAll) {
  Rng rng = stream(9, "test/forest");
  NearestFilter filter(Eigen::VectorXd::Ones(22));
  for (int i = 0; i < 10000; ++i) filter.add(random_vector(22, rng).data());
  std::size_t blocks = 0;
  for (int trial = 0; trial < 100; ++trial) blocks += filter.candidates(random_vector(22, rng).data()).size();
  EXPECT_GE(blocks, 100U);
  EXPECT_LT(blocks, 110U) << "of 625 blocks, one is enough";
}

#ifdef __x86_64__
TEST(NearestFilter, InstructionsTellTheSameBlocks) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) GTEST_SKIP() << "no AVX2 here";
  Rng rng = stream(10, "test/forest");
  constexpr int kBlocks = 40;
  std::vector<float> first(kBlocks * 8 * filter::kBlock);
  std::vector<float> second(kBlocks * 3 * filter::kBlock);
  for (auto* numbers : {&first, &second}) {
    for (float& x : *numbers) x = static_cast<float>(rng.uniform(-3.0, 3.0));
  }
  const float* const groups[] = {first.data(), second.data()};
  for (int trial = 0; trial < 200; ++trial) {
    float target[11];
    for (float& x : target) x = static_cast<float>(rng.uniform(-3.0, 3.0));
    std::vector<float> wide(kBlocks);
    std::vector<float> narrow(kBlocks);
    const filter::Slack slack{1.0F + 1e-5F, 1e-5F};
    const float wide_bound = filter::block_minima_avx2({groups, kBlocks, 11}, target, slack, wide.data());
    const float narrow_bound = filter::block_minima_portable({groups, kBlocks, 11}, target, slack, narrow.data());
    EXPECT_NEAR(wide_bound, narrow_bound, 1e-5 * narrow_bound);
    for (int i = 0; i < kBlocks; ++i) {
      const auto block = static_cast<std::size_t>(i);
      EXPECT_EQ(wide[block] <= wide_bound, narrow[block] <= narrow_bound) << trial << " " << i;
    }
  }
}
#endif

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
