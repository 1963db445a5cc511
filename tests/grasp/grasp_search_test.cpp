// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/grasp_search.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "allegro.hpp"
#include "grasp/certificate.hpp"
#include "recheck.hpp"
#include "robot/collision.hpp"

namespace opponens::grasp {
namespace {

SearchSettings small_search() {
  SearchSettings settings;
  settings.count = 3;
  settings.max_trials = 128;
  settings.threads = 2;
  return settings;
}

std::int64_t total(const SearchResult& result) {
  return std::accumulate(result.rejected.begin(), result.rejected.end(),
                         static_cast<std::int64_t>(result.grasps.size()),
                         [](std::int64_t sum, const auto& entry) { return sum + entry.second; });
}

SearchResult search(const robot::Scene& scene, const SearchSettings& settings, std::uint64_t seed,
                    const Accept& accept = {}) {
  const test::Synergies synergies = test::power_synergies();
  return search_grasps(test::allegro(), scene, "object", synergies.group, synergies.pre_grasp, settings, seed, accept);
}

void expect_good(const SearchResult& result, const robot::Scene& scene, const SearchSettings& settings) {
  ASSERT_FALSE(result.grasps.empty());
  EXPECT_LE(result.grasps.size(), static_cast<std::size_t>(settings.count));
  EXPECT_EQ(total(result), result.trials);
  EXPECT_GT(result.evaluations, result.trials);
  for (std::size_t i = 0; i < result.grasps.size(); ++i) {
    SCOPED_TRACE("grasp " + std::to_string(i));
    test::recheck(result.grasps[i], test::allegro(), scene, test::power_synergies().group, settings);
    if (i > 0) {
      EXPECT_GE(result.grasps[i - 1].quality.epsilon.value(), result.grasps[i].quality.epsilon.value());
    }
  }
}

TEST(GraspSearch, Sphere) {
  const robot::Scene scene = test::scene_of(robot::Sphere{0.035});
  expect_good(search(scene, small_search(), 1), scene, small_search());
}

TEST(GraspSearch, BoxOnATable) {
  const robot::Scene scene = test::with_table(test::scene_of(robot::Box{Eigen::Vector3d(0.06, 0.05, 0.16)}), -0.08);
  const SearchResult result = search(scene, small_search(), 2);
  expect_good(result, scene, small_search());
  const robot::CollisionChecker checker(test::allegro(), scene);
  for (const Grasp& grasp : result.grasps) {
    EXPECT_TRUE(checker.free(grasp.X_OH_pregrasp, grasp.q_pregrasp));  // object and world frames coincide here
    for (const auto& [a, b] : checker.colliding_pairs(grasp.X_OH, grasp.q_grasp)) {
      EXPECT_TRUE(a == "object" || b == "object") << a << " meets " << b;
    }
  }
}

TEST(GraspSearch, SameBytesForAnyThreadCount) {
  const robot::Scene scene = test::scene_of(robot::Sphere{0.035});
  SearchSettings settings = small_search();
  settings.max_trials = 70;  // one batch and a bit
  settings.threads = 1;
  const SearchResult one = search(scene, settings, 3);
  settings.threads = 3;
  const SearchResult three = search(scene, settings, 3);
  EXPECT_EQ(one.rejected, three.rejected);
  EXPECT_EQ(one.evaluations, three.evaluations);
  ASSERT_EQ(one.grasps.size(), three.grasps.size());
  for (std::size_t i = 0; i < one.grasps.size(); ++i) {
    EXPECT_EQ(one.grasps[i].X_OH.matrix(), three.grasps[i].X_OH.matrix());
    EXPECT_EQ(one.grasps[i].q_grasp, three.grasps[i].q_grasp);
    EXPECT_EQ(one.grasps[i].q_pregrasp, three.grasps[i].q_pregrasp);
    EXPECT_EQ(one.grasps[i].quality.epsilon, three.grasps[i].quality.epsilon);
  }
  const SearchResult other = search(scene, settings, 4);  // and another seed is another search
  EXPECT_NE(one.evaluations, other.evaluations);
}

TEST(GraspSearch, NeighboursImproveTheBestAndEveryGraspIsCertified) {
  const robot::Scene scene = test::scene_of(robot::Box{Eigen::Vector3d(0.06, 0.05, 0.12)});
  SearchSettings settings = small_search();
  settings.max_trials = 64;
  int improved = 0;
  for (const std::uint64_t seed : {7, 8, 9}) {
    settings.improvements = 0;
    const SearchResult plain = search(scene, settings, seed);
    settings.improvements = 12;
    const SearchResult better = search(scene, settings, seed);
    ASSERT_FALSE(plain.grasps.empty());
    ASSERT_FALSE(better.grasps.empty());
    EXPECT_GE(better.grasps[0].quality.epsilon.value(), plain.grasps[0].quality.epsilon.value());
    improved += better.grasps[0].quality.epsilon.value() > plain.grasps[0].quality.epsilon.value() ? 1 : 0;
    EXPECT_EQ(total(better), better.trials);
    for (const Grasp& grasp : better.grasps) {
      ASSERT_TRUE(grasp.certificate.has_value());
      EXPECT_EQ(certificate_fault(*grasp.certificate, grasp.contacts, grasp.quality.convention), "");
      test::recheck(grasp, test::allegro(), scene, test::power_synergies().group, settings);
    }
  }
  EXPECT_GE(improved, 1);
}

TEST(GraspSearch, AcceptDecidesAndIsCounted) {
  const robot::Scene scene = test::scene_of(robot::Sphere{0.035});
  SearchSettings settings = small_search();
  settings.max_trials = 64;
  const SearchResult none = search(scene, settings, 5, [](Grasp&) { return std::string("not today"); });
  EXPECT_TRUE(none.grasps.empty());
  EXPECT_GT(none.rejected.at("not today"), 0);
  EXPECT_EQ(total(none), none.trials);
  const SearchResult marked = search(scene, settings, 5, [](Grasp& grasp) {
    grasp.arm_solutions.push_back({Eigen::VectorXd::Zero(6), Eigen::VectorXd::Ones(6)});
    return std::string();
  });
  ASSERT_FALSE(marked.grasps.empty());
  EXPECT_EQ(marked.grasps[0].arm_solutions.size(), 1u);
  const Accept broken = [](Grasp&) -> std::string { throw std::runtime_error("broken"); };
  EXPECT_THROW(search(scene, settings, 5, broken), std::runtime_error);
}

TEST(GraspSearch, AnObjectTooLargeToHoldGivesNoGrasp) {
  SearchSettings settings = small_search();
  settings.max_trials = 64;
  const SearchResult result = search(test::scene_of(robot::Sphere{0.3}), settings, 6);
  EXPECT_TRUE(result.grasps.empty());
  EXPECT_EQ(total(result), 64);
}

TEST(GraspSearch, BrokenContractsThrow) {
  const robot::Scene scene = test::scene_of(robot::Sphere{0.035});
  SearchSettings settings = small_search();
  settings.edges = 2;
  EXPECT_THROW(search(scene, settings, 1), std::invalid_argument);
  settings = small_search();
  settings.threads = 0;
  EXPECT_THROW(validate(settings), std::invalid_argument);
  test::Synergies synergies = test::power_synergies();
  EXPECT_THROW(
      search_grasps(test::allegro(), scene, "nothing", synergies.group, synergies.pre_grasp, small_search(), 1),
      std::invalid_argument);
  synergies.pre_grasp.center.conservativeResize(3);
  EXPECT_THROW(search_grasps(test::allegro(), scene, "object", synergies.group, synergies.pre_grasp, small_search(), 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
