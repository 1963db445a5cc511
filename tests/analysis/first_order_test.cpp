// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Synergies of joint velocities, groups of several labels, and postures, which have neither velocities nor phases.

#include <gtest/gtest.h>

#include "analysis/analyze.hpp"
#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/velocity.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

/// Six movements of two subjects with two objects.
std::vector<Demonstration> movements() {
  std::vector<Demonstration> result;
  for (int i = 0; i < 6; ++i) {
    Rng rng = test::numbered_stream(47, "first order/", i);
    Demonstration movement = test::two_phases(80, 5, 0.5, 0.004, rng);
    movement.id = std::string("m").append(std::to_string(i));
    movement.labels = {{"subject", i < 3 ? "1" : "2"}, {"object", i % 2 == 0 ? "cup" : "pen"}};
    result.push_back(movement);
  }
  return result;
}

AnalysisSettings velocity_settings() {
  AnalysisSettings settings;
  settings.group_by = "object";
  settings.order = 1;
  settings.replicates = 20;
  return settings;
}

TEST(FirstOrder, AreThePrincipalAxesOfTheVelocitiesOfTheSamePhases) {
  const std::vector<Demonstration> all = movements();
  const Analysis found = analyze(all, velocity_settings()).value();
  EXPECT_EQ(found.synergies.order, 1);
  AnalysisSettings of_positions = velocity_settings();
  of_positions.order = 0;
  const Analysis positions = analyze(all, of_positions).value();
  EXPECT_EQ(positions.synergies.order, 0);
  SampleStatistics before;
  SampleStatistics cup;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int split = positions.transitions[i].likeness.index;
    EXPECT_EQ(found.transitions[i].likeness.index, split) << "phases are found in the positions";
    const Eigen::MatrixXd v = joint_velocities(all[i].time, all[i].q_h);
    before = merge(before, moments(v.topRows(split)));
    if (i % 2 == 0) cup = merge(cup, moments(v.bottomRows(v.rows() - split)));
  }
  const SynergyBasis expected = principal_axes(before);
  EXPECT_TRUE(found.synergies.pre_grasp.basis.mean.isApprox(expected.mean, 1e-12));
  EXPECT_TRUE(found.synergies.pre_grasp.basis.variance.isApprox(expected.variance, 1e-12));
  EXPECT_TRUE(found.synergies.grasp.at(0).basis.variance.isApprox(principal_axes(cup).variance, 1e-12));
  EXPECT_FALSE(positions.synergies.pre_grasp.basis.variance.isApprox(expected.variance, 0.1));
}

TEST(FirstOrder, AChannelOfNoiseAloneIsDroppedInBothOrders) {
  // Uniform noise of the size that the sensor's resolution makes: below it as an angle, and below what it makes of a
  // velocity.
  std::vector<Demonstration> all = movements();
  for (std::size_t i = 0; i < all.size(); ++i) {
    Rng rng = test::numbered_stream(48, "still channel/", static_cast<int>(i));
    for (Eigen::Index t = 0; t < all[i].q_h.rows(); ++t) all[i].q_h(t, 2) = 0.3 + rng.uniform(-0.004, 0.004);
  }
  for (const int order : {0, 1}) {
    AnalysisSettings settings = velocity_settings();
    settings.order = order;
    const Analysis found = analyze(all, settings).value();
    EXPECT_EQ(found.synergies.pre_grasp.dropped_channels, std::vector<std::string>{"c"}) << order;
    EXPECT_EQ(found.synergies.pre_grasp.dof_effective, 4) << order;
  }
}

TEST(GroupOf, OneLabelOrSeveral) {
  const Demonstration movement = movements().front();
  EXPECT_EQ(group_of(movement, "object"), "cup");
  EXPECT_EQ(group_of(movement, "subject,object"), "1/cup");
  EXPECT_EQ(group_of(movement, "object,subject"), "cup/1");
  for (const char* absent : {"family", "object,family", "object,", ",object", ""}) {
    EXPECT_EQ(group_of(movement, absent), std::nullopt) << absent;
  }
  AnalysisSettings settings = velocity_settings();
  settings.order = 0;
  settings.group_by = "subject,object";
  const Analysis found = analyze(movements(), settings).value();
  std::vector<std::string> names;
  for (const SynergyGroup& group : found.synergies.grasp) names.push_back(group.name);
  EXPECT_EQ(names, (std::vector<std::string>{"1/cup", "1/pen", "2/cup", "2/pen"}));
}

TEST(Postures, HaveNeitherPhasesNorVelocities) {
  std::vector<Demonstration> all = movements();
  for (Demonstration& one : all) one.labels["kind"] = "postures";
  AnalysisSettings settings = velocity_settings();
  settings.order = 0;
  EXPECT_EQ(analyze(all, settings).error().code, FailureCode::invalid_input);
  settings.transition.reset();
  EXPECT_TRUE(analyze(all, settings).has_value());
  settings.order = 1;
  EXPECT_NE(analyze(all, settings).error().detail.find("no velocities"), std::string::npos);
}

}  // namespace
}  // namespace opponens::analysis
