// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/simulate.hpp"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

using test::human_model;

TEST(MinimumJerk, EndsSmoothlyAndPeaksInTheMiddle) {
  EXPECT_EQ(minimum_jerk(-1.0), 0.0);
  EXPECT_EQ(minimum_jerk(2.0), 1.0);
  EXPECT_DOUBLE_EQ(minimum_jerk(0.5), 0.5);
  const double h = 1e-5;
  const auto speed = [&](double u) { return (minimum_jerk(u + h) - minimum_jerk(u - h)) / (2 * h); };
  EXPECT_NEAR(speed(0.0), 0.0, 1e-8);
  EXPECT_NEAR(speed(1.0), 0.0, 1e-8);
  EXPECT_NEAR(speed(0.5), 1.875, 1e-8);  // 30 u^2 (1 - u)^2
}

TEST(Simulate, TheFormOfThePapersRecordings) {
  const SimulationModel model = human_model();
  const std::vector<Demonstration> recordings = simulate(model, {}, 1);
  int grasps = 0;
  Eigen::Index samples = 0;
  std::set<std::string> ids;
  std::set<std::string> objects;
  std::map<std::string, std::set<std::string>> types_of_family;
  for (const Demonstration& recording : recordings) {
    EXPECT_TRUE(ids.insert(recording.id).second) << recording.id;
    EXPECT_EQ(recording.origin, Origin::simulated);
    EXPECT_EQ(recording.joint_names.size(), 22u);
    EXPECT_EQ(recording.q_h.rows(), recording.time.size());
    EXPECT_NEAR(recording.time[1] - recording.time[0], 0.02, 1e-12);
    if (recording.labels.at("kind") == "free") {
      EXPECT_FALSE(recording.known_transition);
      continue;
    }
    ++grasps;
    samples += recording.q_h.rows();
    objects.insert(recording.labels.at("object"));
    types_of_family[recording.labels.at("family")].insert(recording.labels.at("grasp_type"));
    ASSERT_TRUE(recording.known_transition);
    EXPECT_GT(*recording.known_transition, 0.2 * recording.time[recording.time.size() - 1]);
    EXPECT_LT(*recording.known_transition, 0.8 * recording.time[recording.time.size() - 1]);
  }
  EXPECT_EQ(grasps, 180);
  EXPECT_EQ(recordings.size(), 186u);
  EXPECT_GT(samples, 15000);
  EXPECT_EQ(objects.size(), 9u);
  EXPECT_EQ(types_of_family.size(), 4u);
  std::size_t types = 0;
  for (const auto& [family, names] : types_of_family) types += names.size();
  EXPECT_EQ(types, 15u);
}

TEST(Simulate, OnlyThePapersFourExamplesAreNotAssumed) {
  std::set<std::string> certain;
  for (const SimulatedGraspType& type : human_model().types) {
    if (!type.family_assumed) certain.insert(type.name);
  }
  EXPECT_EQ(certain, (std::set<std::string>{"lateral_pinch", "medium_wrap", "thumb_2_finger", "thumb_3_finger"}));
}

TEST(Simulate, SameSeedSameNumbersAndStreamsAreIndependent) {
  SimulationModel model = human_model();
  const auto first = simulate(model, {}, 3);
  const auto again = simulate(model, {}, 3);
  const auto other = simulate(model, {}, 4);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_TRUE(first[i].q_h == again[i].q_h) << first[i].id;
  EXPECT_FALSE(first[0].q_h.row(0) == other[0].q_h.row(0));
  // One type fewer, fewer repetitions: the others stay as they were.
  model.types.erase(model.types.begin());
  const auto fewer = simulate(model, {.repetitions = 2}, 3);
  EXPECT_EQ(fewer[0].id, first[12].id);
  EXPECT_TRUE(fewer[0].q_h == first[12].q_h);
}

TEST(Simulate, OpensAloneThenDependsOnTheType) {
  // Without variation between repetitions, all types are the same until the known transition and differ at the end.
  SimulationModel model = human_model();
  model.duration_spread = model.onset_spread = model.amplitude_spread = 0.0;
  model.rest_spread = model.open_spread = model.end_spread = model.noise = model.resolution = 0.0;
  const auto recordings = simulate(model, {.repetitions = 1}, 1);
  const auto before = static_cast<Eigen::Index>(std::floor(*recordings[0].known_transition / 0.02)) + 1;
  const std::size_t types = model.types.size();
  for (std::size_t i = 0; i < types; ++i) {
    EXPECT_TRUE(recordings[i].q_h.topRows(before).isApprox(recordings[0].q_h.topRows(before), 1e-12));
    EXPECT_TRUE(recordings[i].q_h.row(0).transpose().isApprox(model.rest, 1e-12));
    const Eigen::Index last = recordings[i].q_h.rows() - 1;
    EXPECT_LT((recordings[i].q_h.row(last).transpose() - model.types[i].ends[0].posture).norm(), 0.02);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((model.types[i].ends[0].posture - model.types[j].ends[0].posture).norm(), 0.1)
          << model.types[i].name << " and " << model.types[j].name;
    }
  }
}

TEST(Simulate, RoundedToTheSensorAndNearTheJointRanges) {
  const SimulationModel model = human_model();
  for (const Demonstration& recording : simulate(model, {}, 2)) {
    const Eigen::MatrixXd steps = recording.q_h / model.resolution;
    EXPECT_LT((steps.array() - steps.array().round()).abs().maxCoeff(), 1e-6) << recording.id;
    const double margin = 6 * model.noise + model.resolution;
    EXPECT_GT((recording.q_h.rowwise() - model.lower.transpose()).minCoeff(), -margin) << recording.id;
    EXPECT_LT((recording.q_h.rowwise() - model.upper.transpose()).maxCoeff(), margin) << recording.id;
  }
}

TEST(Simulate, FreeMotionOwesNothingToTheGrasps) {
  SimulationModel model = human_model();
  const auto before = simulate(model, {}, 5);
  model.rest = model.open = 0.5 * (model.lower + model.upper);
  for (SimulatedGraspType& type : model.types) type.ends = {{"other", model.open}};
  const auto after = simulate(model, {}, 5);
  for (std::size_t i = 180; i < 186; ++i) EXPECT_TRUE(before[i].q_h == after[i].q_h);
  // Every finger uses most of its range, and fingers move apart: correlation across fingers is far from 1.
  const SampleStatistics s = moments(before[180].q_h);
  const Eigen::VectorXd deviation = s.covariance.diagonal().cwiseSqrt();
  EXPECT_GT(deviation[4], 0.1 * (model.upper[4] - model.lower[4]));
  EXPECT_LT(std::abs(s.covariance(4, 15)) / (deviation[4] * deviation[15]), 0.8);  // index and little MCP
  EXPECT_GT(s.covariance(4, 5) / (deviation[4] * deviation[5]), 0.6);              // index MCP and PIP
}

TEST(Simulate, BrokenContracts) {
  SimulationModel model = human_model();
  EXPECT_THROW(simulate(model, {.repetitions = 0}, 1), std::invalid_argument);
  model.types[0].ends[0].posture[0] = 9.0;
  EXPECT_THROW(simulate(model, {}, 1), std::invalid_argument);
  model = human_model();
  model.open.conservativeResize(3);
  EXPECT_THROW(simulate(model, {}, 1), std::invalid_argument);
  model = human_model();
  model.onset_spread = 0.7;
  EXPECT_THROW(simulate(model, {}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::analysis
