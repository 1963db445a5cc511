// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/analyze.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

const std::vector<Demonstration>& recordings() {
  static const std::vector<Demonstration> result = simulate(test::human_model(), {}, 1);
  return result;
}

AnalysisSettings quick() {
  AnalysisSettings settings;
  settings.replicates = 20;
  return settings;
}

std::string detail(const Result<Analysis>& result, FailureCode code) {
  EXPECT_FALSE(result);
  if (result) return {};
  EXPECT_EQ(result.error().code, code) << result.error().detail;
  return result.error().detail;
}

TEST(Analyze, SimulatedRecordingsEndToEnd) {
  const Analysis analysis = analyze(recordings(), quick()).value();
  ASSERT_EQ(analysis.groups.size(), 5u);
  ASSERT_EQ(analysis.synergies.grasp.size(), 4u);
  EXPECT_EQ(analysis.transitions.size(), 180u);
  ASSERT_TRUE(analysis.free_motion);
  EXPECT_NE(analysis.free_motion->name.find("simulated"), std::string::npos);
  int samples = 0;
  for (std::size_t i = 0; i < analysis.groups.size(); ++i) {
    const GroupReport& group = analysis.groups[i];
    const SynergyGroup& synergies = i == 0 ? analysis.synergies.pre_grasp : analysis.synergies.grasp[i - 1];
    samples += group.samples;
    EXPECT_EQ(group.name, std::vector<std::string>({"pre-grasp", "1", "2", "3", "4"})[i]);
    EXPECT_EQ(group.phase, i == 0 ? "pre-grasp" : "grasp");
    EXPECT_EQ(group.cluster, "recording");
    EXPECT_EQ(group.clusters, group.recordings);
    EXPECT_EQ(synergies.name, group.name);
    EXPECT_EQ(synergies.dof_effective + static_cast<int>(synergies.dropped_channels.size()), 22);
    EXPECT_EQ(synergies.box.axes.cols(), group.k);
    EXPECT_GE(group.cumulative_variance[group.k - 1], 0.95);
    EXPECT_TRUE(group.k == 1 || group.cumulative_variance[group.k - 2] < 0.95);
    ASSERT_EQ(group.intervals.size(), 22u);
    EXPECT_NEAR(group.coverage.full.nominal, 0.95, 1e-12);
    EXPECT_GT(group.coverage.kept.in_sample, group.coverage.full.in_sample - 1e-12);
    ASSERT_TRUE(group.coverage.full.held_out && group.coverage.full.interval);
    EXPECT_LE(*group.coverage.full.held_out, group.coverage.full.in_sample);
  }
  Eigen::Index all = 0;
  for (const Demonstration& recording : recordings())
    all += recording.labels.at("kind") == "free" ? 0 : recording.q_h.rows();
  EXPECT_EQ(samples, all);  // every sample in exactly one phase
}

TEST(Analyze, PoolsExactlyTheSamplesOfThePhases) {
  const std::vector<Demonstration> all = recordings();
  const Analysis analysis = analyze(all, quick()).value();
  std::vector<SampleStatistics> before;
  std::vector<SampleStatistics> family_two;
  for (std::size_t i = 0; i < 180; ++i) {
    const TransitionReport& found = analysis.transitions[i];
    EXPECT_EQ(found.demonstration, all[i].id);
    const Eigen::Index t = found.likeness.index;
    before.push_back(moments(all[i].q_h.topRows(t)));
    if (all[i].labels.at("family") == "2") family_two.push_back(moments(all[i].q_h.bottomRows(all[i].q_h.rows() - t)));
    const double duration = all[i].time[all[i].time.size() - 1];
    EXPECT_NEAR(*found.likeness_error * duration, found.likeness.time_s - *all[i].known_transition, 1e-12);
  }
  EXPECT_TRUE(analysis.synergies.pre_grasp.basis.variance.isApprox(principal_axes(pooled(before)).variance, 1e-11));
  EXPECT_TRUE(analysis.synergies.grasp[1].basis.variance.isApprox(principal_axes(pooled(family_two)).variance, 1e-11));
}

TEST(Analyze, OrderOfRecordingsDoesNotMatter) {
  std::vector<Demonstration> shuffled = recordings();
  std::reverse(shuffled.begin(), shuffled.end());
  const Analysis a = analyze(recordings(), quick()).value();
  const Analysis b = analyze(shuffled, quick()).value();
  for (std::size_t i = 0; i < a.groups.size(); ++i) {
    EXPECT_TRUE(a.groups[i].cumulative_variance == b.groups[i].cumulative_variance);
    EXPECT_EQ(a.groups[i].intervals[0].low, b.groups[i].intervals[0].low);
    EXPECT_EQ(a.groups[i].coverage.full.held_out, b.groups[i].coverage.full.held_out);
    EXPECT_EQ(a.groups[i].coverage.full.interval->high, b.groups[i].coverage.full.interval->high);
  }
  EXPECT_TRUE(a.synergies.pre_grasp.basis.axes == b.synergies.pre_grasp.basis.axes);
}

void expect_equal(const Analysis& a, const Analysis& b) {
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (std::size_t i = 0; i < a.groups.size(); ++i) {
    EXPECT_EQ(a.groups[i].cumulative_variance, b.groups[i].cumulative_variance);
    EXPECT_EQ(a.groups[i].intervals[0].low, b.groups[i].intervals[0].low);
    EXPECT_EQ(a.groups[i].coverage.full.in_sample, b.groups[i].coverage.full.in_sample);
    EXPECT_EQ(a.groups[i].coverage.full.held_out, b.groups[i].coverage.full.held_out);
    EXPECT_EQ(a.groups[i].coverage.kept.interval->high, b.groups[i].coverage.kept.interval->high);
  }
  ASSERT_EQ(a.transitions.size(), b.transitions.size());
  for (std::size_t i = 0; i < a.transitions.size(); ++i) {
    EXPECT_EQ(a.transitions[i].demonstration, b.transitions[i].demonstration);
    EXPECT_EQ(a.transitions[i].likeness.index, b.transitions[i].likeness.index);
  }
  EXPECT_EQ(a.free_motion->covariance, b.free_motion->covariance);
}

TEST(Analyze, ThreadsDoNotMatterAndEveryRecordingIsReadInOrder) {
  const Analysis one = analyze(recordings(), quick()).value();
  for (const int threads : {1, 2, 5}) {
    std::vector<std::size_t> read;
    const RecordingSource source{recordings().size(), [&](std::size_t i) {
                                   read.push_back(i);
                                   return recordings()[i];
                                 }};
    std::size_t last = 0;
    const Reading reading{threads, [&](std::size_t done, std::size_t) {
                            EXPECT_GE(done, last);
                            last = done;
                          }};
    expect_equal(analyze(source, quick(), reading).value(), one);
    EXPECT_EQ(read.size(), 1u + 186u + 180u);  // the names of the joints; all; the movements again
    EXPECT_TRUE(std::is_sorted(read.begin() + 1, read.begin() + 187));
    EXPECT_TRUE(std::is_sorted(read.begin() + 187, read.end()));
  }
}

TEST(Analyze, ProgressAndReadingMayThrow) {
  struct Stop {};
  const Reading stops{3, [](std::size_t done, std::size_t) {
                        if (done == 200) throw Stop{};
                      }};
  EXPECT_THROW(static_cast<void>(analyze(source_of(recordings()), quick(), stops)), Stop);
  const RecordingSource broken{recordings().size(), [](std::size_t i) {
                                 if (i == 77) throw Stop{};
                                 return recordings()[i];
                               }};
  EXPECT_THROW(static_cast<void>(analyze(broken, quick(), {3, {}})), Stop);
}

TEST(Analyze, NormalisedSpaceIsAnalysisOfNormalisedJoints) {
  const SimulationModel model = test::human_model();
  AnalysisSettings settings = quick();
  settings.transition = TransitionRule::changepoint;
  settings.normalize_by = JointRanges{model.lower, model.upper};
  const Analysis analysis = analyze(recordings(), settings).value();
  const SynergyGroup& group = analysis.synergies.grasp[0];
  const Eigen::VectorXd range = model.upper - model.lower;
  EXPECT_TRUE(group.box.scale == range);
  const SynergyGroup in_radians = analyze(recordings(),
                                          [] {
                                            AnalysisSettings radians = quick();
                                            radians.transition = TransitionRule::changepoint;
                                            return radians;
                                          }())
                                      .value()
                                      .synergies.grasp[0];
  EXPECT_TRUE((group.box.center.cwiseProduct(range)).isApprox(in_radians.box.center, 1e-12));
  EXPECT_GT((group.basis.axes - in_radians.basis.axes).norm(), 0.1);
  const Eigen::VectorXd q = configuration(group.box, group.box.half_width);
  EXPECT_TRUE(contains(group.box, q));
  EXPECT_TRUE(coordinates(group.box, q).isApprox(group.box.half_width, 1e-9));
}

TEST(Analyze, WithoutASplitTheGroupsHoldEverything) {
  AnalysisSettings settings = quick();
  settings.transition.reset();
  settings.group_by = "object";
  const Analysis analysis = analyze(recordings(), settings).value();
  EXPECT_TRUE(analysis.transitions.empty());
  EXPECT_EQ(analysis.synergies.grasp.size(), 9u);
  EXPECT_EQ(analysis.synergies.pre_grasp.phase, "all");
  int samples = 0;
  for (std::size_t i = 1; i < analysis.groups.size(); ++i) {
    EXPECT_EQ(analysis.groups[i].phase, "all");
    samples += analysis.groups[i].samples;
  }
  EXPECT_EQ(samples, analysis.groups[0].samples);
}

TEST(Analyze, SubjectsAreTheClustersWhenThereAreSeveral) {
  std::vector<Demonstration> two = recordings();
  for (std::size_t i = 0; i < two.size(); ++i) two[i].labels["subject"] = std::string(1, i % 2 == 0 ? 'a' : 'b');
  const Analysis analysis = analyze(two, quick()).value();
  for (const GroupReport& group : analysis.groups) {
    EXPECT_EQ(group.cluster, "subject");
    EXPECT_EQ(group.clusters, 2);
    EXPECT_TRUE(group.coverage.full.held_out);
  }
}

TEST(Analyze, ASingleRecordingHasNoIntervals) {
  AnalysisSettings settings = quick();
  settings.min_window = 30;  // more samples than joints in either phase
  const Analysis analysis = analyze({recordings()[0]}, settings).value();
  EXPECT_TRUE(analysis.groups[1].intervals.empty());
  EXPECT_FALSE(analysis.groups[1].coverage.full.held_out);
  EXPECT_FALSE(analysis.groups[1].coverage.full.interval);
  EXPECT_FALSE(analysis.free_motion);
}

TEST(Analyze, FailuresNameRecordingOrGroup) {
  std::vector<Demonstration> some(recordings().begin(), recordings().begin() + 4);
  EXPECT_NE(detail(analyze({}, quick()), FailureCode::invalid_input), "");
  AnalysisSettings settings = quick();
  settings.group_by = "colour";
  EXPECT_NE(detail(analyze(some, settings), FailureCode::invalid_input).find("colour"), std::string::npos);

  auto broken = some;
  broken[2].q_h(5, 5) = std::nan("");
  EXPECT_NE(detail(analyze(broken, quick()), FailureCode::invalid_input).find(broken[2].id), std::string::npos);
  broken = some;
  broken[1].time[7] = broken[1].time[6];
  EXPECT_NE(detail(analyze(broken, quick()), FailureCode::invalid_input).find("time"), std::string::npos);
  broken = some;
  std::swap(broken[3].joint_names[0], broken[3].joint_names[1]);
  EXPECT_NE(detail(analyze(broken, quick()), FailureCode::invalid_input).find("joints"), std::string::npos);
  broken = some;
  broken[3].q_h.setConstant(0.1);
  EXPECT_NE(detail(analyze(broken, quick()), FailureCode::degenerate).find(broken[3].id), std::string::npos);
  EXPECT_EQ(detail(analyze({recordings()[185]}, quick()), FailureCode::invalid_input), "no movements to analyze");

  broken = some;
  broken.push_back(some[1]);
  broken.back().q_h.array() += 0.01;  // other samples under the same name are no second recording either
  EXPECT_NE(detail(analyze(broken, quick()), FailureCode::invalid_input).find(some[1].id + " is given twice"),
            std::string::npos);
  broken.back().labels["source"] = "another";  // two sources may use one name
  EXPECT_TRUE(analyze(broken, quick()));

  // A group with fewer samples than joints, although its one recording can be split.
  settings = quick();
  settings.min_window = 5;
  broken = some;
  broken[0].labels["family"] = "tiny";
  broken[0].time.conservativeResize(20);
  broken[0].q_h.conservativeResize(20, Eigen::NoChange);
  EXPECT_NE(detail(analyze(broken, settings), FailureCode::too_few_samples).find("group tiny"), std::string::npos);
}

TEST(Analyze, SettingsAreChecked) {
  const auto rejects = [](auto&& change) {
    AnalysisSettings settings;
    change(settings);
    EXPECT_THROW(validate(settings), std::invalid_argument);
  };
  rejects([](AnalysisSettings& s) { s.alpha = 5; });
  rejects([](AnalysisSettings& s) { s.beta = 0; });
  rejects([](AnalysisSettings& s) { s.confidence = 1; });
  rejects([](AnalysisSettings& s) { s.resolution = -1; });
  rejects([](AnalysisSettings& s) { s.replicates = 1; });
  rejects([](AnalysisSettings& s) { s.min_window = 1; });
  rejects([](AnalysisSettings& s) { s.group_by.clear(); });
  rejects([](AnalysisSettings& s) { s.normalize_by = JointRanges{Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1)}; });
  EXPECT_NO_THROW(validate(AnalysisSettings{}));
}

}  // namespace
}  // namespace opponens::analysis
