// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/given_grasps.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "allegro.hpp"
#include "analysis/synergy_box.hpp"

namespace opponens::grasp {
namespace {

const robot::Scene& ball() {
  static const robot::Scene scene = test::scene_of(robot::Sphere{0.035});
  return scene;
}

/// One grasp that the search finds.
const Grasp& found() {
  static const Grasp grasp = [] {
    SearchSettings settings;
    settings.count = 1;
    settings.max_trials = 64;
    settings.min_trials = 0;
    settings.threads = 2;
    const test::Synergies synergies = test::power_synergies();
    return search_grasps(test::allegro(), ball(), "object", synergies.group, synergies.pre_grasp, settings, 1)
        .grasps.at(0);
  }();
  return grasp;
}

/// A second group far from the first.
std::vector<SynergyGroup> two_groups() {
  SynergyGroup other = test::power_synergies().group;
  other.name = "far";
  other.box.center.array() += 1.0;
  return {other, test::power_synergies().group};
}

std::vector<GivenGrasp> check(const std::vector<HandPose>& postures, const SearchSettings& settings = {},
                              const Accept& accept = {}) {
  const std::vector<SynergyGroup> groups = two_groups();
  const SynergyBox pre_grasp = test::power_synergies().pre_grasp;
  static const SearchWorld world = make_search_world(test::allegro(), ball(), "object", 2);
  return check_given({world, groups, pre_grasp, settings}, postures, accept);
}

TEST(GivenGrasps, WhatTheSearchFoundComesOutTheSame) {
  const auto checked = check({{found().X_OH, found().q_grasp}});
  ASSERT_TRUE(checked.at(0).grasp) << checked[0].reason;
  const Grasp& grasp = *checked[0].grasp;
  EXPECT_EQ(grasp.origin, GraspOrigin::imported);
  EXPECT_EQ(grasp.group, "power");
  EXPECT_EQ(grasp.quality.epsilon, found().quality.epsilon);
  EXPECT_EQ(grasp.contacts.size(), found().contacts.size());
  EXPECT_EQ(grasp.q_pregrasp, found().q_pregrasp);
  EXPECT_EQ(grasp.X_OH_pregrasp.matrix(), found().X_OH_pregrasp.matrix());
  EXPECT_EQ(grasp.slack, found().slack);
  EXPECT_EQ(grasp.coefficients, found().coefficients);
}

TEST(GivenGrasps, EachIsRefusedForItsOwnReason) {
  HandPose away{found().X_OH, found().q_grasp};
  away.X_OH.translation() += Eigen::Vector3d(0, 0, 1);
  HandPose bent{found().X_OH, found().q_grasp};
  bent.q[2] = 3.0;
  const HandPose good{found().X_OH, found().q_grasp};
  const auto checked = check({away, bent, good});
  EXPECT_EQ(checked.at(0).reason, "fewer than three contacts");
  EXPECT_EQ(checked.at(1).reason.rfind("outside the joint limits: joint_2.0 at 3.0000 rad", 0), 0U)
      << checked[1].reason;
  EXPECT_TRUE(checked.at(2).grasp);
  SearchSettings slippery;
  slippery.mu = 0.0;
  EXPECT_EQ(check({good}, slippery).at(0).reason, "not force closure");
  EXPECT_EQ(check({good}, {}, [](Grasp&) { return std::string("no"); }).at(0).reason, "no");
  SearchSettings roomy;
  roomy.clearance_pregrasp = 0.3;  // more than the hand is drawn back at most
  EXPECT_EQ(check({good}, roomy).at(0).reason, "no clear pre-grasp");
}

TEST(GivenGrasps, DescribedAlongTheNearestGroup) {
  const std::vector<SynergyGroup> groups = two_groups();
  EXPECT_EQ(nearest_group(groups, found().q_grasp), 1U);
  const SynergyBox& far = groups[0].box;
  EXPECT_EQ(nearest_group(groups, analysis::configuration(far, far.half_width)), 0U);
  Grasp grasp = found();
  describe_along(groups[0], 0.3, grasp);
  EXPECT_EQ(grasp.group, "far");
  EXPECT_FALSE(grasp.synergy_grasp);
  EXPECT_LT((analysis::configuration(far, grasp.coefficients) + grasp.slack - grasp.q_grasp).norm(), 1e-12);
  EXPECT_TRUE((grasp.coefficients.cwiseAbs().array() <= far.half_width.array() + 1e-12).all());
  describe_along(groups[0], grasp.slack.norm() + 1e-9, grasp);
  EXPECT_TRUE(grasp.synergy_grasp);
  EXPECT_THROW(nearest_group({}, found().q_grasp), std::invalid_argument);
}

TEST(GivenGrasps, BrokenContractsThrow) {
  EXPECT_THROW(check({{found().X_OH, Eigen::VectorXd::Zero(3)}}), std::invalid_argument);
  HandPose nowhere{found().X_OH, found().q_grasp};
  nowhere.q[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check({nowhere}), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::grasp
