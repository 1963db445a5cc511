// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the statistics answer where their formulas end. Every factorisation, logarithm and division of analysis/ and its
// guard (integer divisions left out):
//
//   statistics, moment_kernel   / rows                      at least one row is required; count of a merge is a sum > 0
//   pca                         eigenvectors, no inverse    finite covariance required; nothing varies: shares are all
//   1 subspace                    / sqrt(remaining)           only of channels above a floor that is > 0 likeness
//   Cholesky                    not positive definite: Failure degenerate phase_transition            Cholesky, 1 /
//   sqrt(pivot)   pivot > 0, else Failure degenerate; windows of >= 2 samples
//                               / duration                  time that increases is required
//   synergy_box                 1 / n, 1 / k                n, k >= 1 required; an axis of zero width has half width 0
//   coverage                    / total                     clusters have samples; tolerance of one sensor resolution
//   intervals                   logit                       shares of 0 and 1 take the percentile interval; total > 0
//   human_likeness              / (length s1)               no motion or no variance: nullopt
//   velocity                    / time steps                time that increases is required (velocity_test)
//   synergy_distance            / total variance            0 when nothing varies (synergy_distance_test)
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "analysis/analyze.hpp"
#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

constexpr double kResolution = 0.0087;

Demonstration labelled(Demonstration recording, const std::string& id) {
  recording.id = id;
  recording.labels = {{"family", "1"}, {"subject", "s"}};
  return recording;
}

std::vector<Demonstration> plain(int count, int samples = 120) {
  std::vector<Demonstration> result;
  for (int i = 0; i < count; ++i) {
    Rng rng = test::numbered_stream(70, "plain/", i);
    result.push_back(
        labelled(test::two_phases(samples, 4, 0.5, 0.02, rng), std::string("r").append(std::to_string(i))));
  }
  return result;
}

AnalysisSettings few_replicates() {
  AnalysisSettings settings;
  settings.replicates = 20;
  settings.min_window = 10;
  return settings;
}

/// Every number of a result is one.
void expect_finite(const Analysis& found) {
  for (std::size_t i = 0; i < found.groups.size(); ++i) {
    const GroupReport& report = found.groups[i];
    const SynergyGroup& group = i == 0 ? found.synergies.pre_grasp : found.synergies.grasp[i - 1];
    EXPECT_TRUE(report.cumulative_variance.allFinite());
    EXPECT_TRUE(group.basis.axes.allFinite() && group.basis.mean.allFinite() && group.basis.variance.allFinite());
    EXPECT_TRUE(group.box.half_width.allFinite());
    EXPECT_TRUE((group.basis.axes.transpose() * group.basis.axes).isIdentity(1e-9));
    for (const Interval& interval : report.intervals) {
      EXPECT_TRUE(interval.low >= 0.0 && interval.low <= interval.high && interval.high <= 1.0);
    }
    EXPECT_TRUE(report.coverage.full.in_sample >= 0.0 && report.coverage.full.in_sample <= 1.0);
  }
}

TEST(Degenerate, ConstantAndDependentChannelsAreDroppedByName) {
  std::vector<Demonstration> recordings = plain(4);
  for (Demonstration& one : recordings) {
    one.q_h.col(1).setConstant(0.4);
    one.q_h.col(3) = 0.5 * one.q_h.col(0) - 0.25 * one.q_h.col(2);
  }
  const Analysis found = analyze(recordings, few_replicates()).value();
  expect_finite(found);
  for (std::size_t i = 0; i < found.groups.size(); ++i) {
    const SynergyGroup& group = i == 0 ? found.synergies.pre_grasp : found.synergies.grasp[i - 1];
    EXPECT_EQ(group.dof_effective, 2);
    EXPECT_EQ(group.dropped_channels.size(), 2u);
    EXPECT_EQ(group.dropped_channels.front(), "b");
    EXPECT_LT(group.basis.variance[2], 1e-12);
  }
  EXPECT_EQ(found.transitions.front().dropped_channels.size(), 2u);
  // Without a ridge the two rules are as well defined, in the subspace.
  TransitionSettings exact;
  exact.resolution = 0.0;
  const TransitionCurves curves = transition_curves(recordings.front(), exact).value();
  EXPECT_TRUE(curves.log_likeness.allFinite() && curves.changepoint.allFinite());
  EXPECT_EQ(curves.kept.size(), 2u);
}

TEST(Degenerate, FewerSamplesThanChannels) {
  Rng rng = stream(71, "few");
  const SampleStatistics few = moments(test::normal_matrix(3, 6, rng));
  EXPECT_EQ(effective_subspace(few.covariance, Eigen::VectorXd::Zero(6)).dof(), 2);
  EXPECT_TRUE(principal_axes(few).axes.allFinite());
  const SampleStatistics one = moments(test::normal_matrix(1, 6, rng));
  EXPECT_EQ(one.covariance, Eigen::MatrixXd::Zero(6, 6));
  const auto likeness = log_likeness(few, few, 0.0);
  ASSERT_FALSE(likeness);
  EXPECT_EQ(likeness.error().code, FailureCode::degenerate);
  EXPECT_TRUE(log_likeness(few, few, kResolution * kResolution));
  const auto curves = transition_curves(test::recording("short", test::normal_matrix(6, 6, rng)), {});
  ASSERT_FALSE(curves);
  EXPECT_EQ(curves.error().code, FailureCode::too_few_samples);
  const auto tiny = analyze(plain(1, 8), [] {
    AnalysisSettings settings = few_replicates();
    settings.min_window = 4;
    return settings;
  }());
  ASSERT_FALSE(tiny);
  EXPECT_EQ(tiny.error().code, FailureCode::too_few_samples);
}

TEST(Degenerate, OneRecording) {
  const Analysis found = analyze(plain(1), few_replicates()).value();
  expect_finite(found);
  for (const GroupReport& group : found.groups) {
    EXPECT_TRUE(group.intervals.empty());
    EXPECT_FALSE(group.coverage.full.held_out);
  }
}

TEST(Degenerate, AllSamplesEqual) {
  std::vector<Demonstration> recordings = plain(3);
  for (Demonstration& one : recordings) one.q_h.setConstant(0.3);
  const auto split = analyze(recordings, few_replicates());
  ASSERT_FALSE(split);
  EXPECT_EQ(split.error().code, FailureCode::degenerate);
  AnalysisSettings whole = few_replicates();
  whole.transition.reset();
  const auto all = analyze(recordings, whole);
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().code, FailureCode::degenerate);
  const SampleStatistics still = moments(recordings.front().q_h);
  EXPECT_EQ(still.covariance, Eigen::MatrixXd::Zero(4, 4));
  const SynergyBasis basis = principal_axes(still);
  EXPECT_EQ(cumulative_variance(basis.variance), Eigen::VectorXd::Ones(4));
  const SynergyBox box = make_box(basis, Eigen::VectorXd::Ones(4), 0.05, 0.05, BoxRoot::n, 1);
  EXPECT_EQ(box.half_width, Eigen::VectorXd::Zero(1));
  EXPECT_TRUE(contains(box, still.mean));
  const Walls walls = make_walls(still, {0.05, 0.05, BoxRoot::n, Eigen::VectorXd::Constant(4, kResolution), 20, 0.95});
  const Tally inside = count_inside(walls, recordings.front().q_h, 1.0);
  EXPECT_EQ(inside.full, inside.total);
  EXPECT_FALSE(human_likeness(recordings.front().q_h, {"still", Eigen::MatrixXd::Identity(4, 4)}));
  EXPECT_FALSE(human_likeness(plain(1).front().q_h, {"nothing varies", Eigen::MatrixXd::Zero(4, 4)}));
}

TEST(Degenerate, LargeMeanSmallSpread) {
  std::vector<Demonstration> near = plain(4);
  for (Demonstration& one : near) one.q_h *= 1e-3;
  std::vector<Demonstration> far = near;
  for (Demonstration& one : far) one.q_h.array() += 1e6;
  AnalysisSettings fine = few_replicates();
  fine.resolution = 1e-6;
  const Analysis expected = analyze(near, fine).value();
  const Analysis found = analyze(far, fine).value();
  expect_finite(found);
  for (std::size_t i = 0; i < found.groups.size(); ++i) {
    // Storing 1e6 + x rounds x to 1.2e-10, a ten-millionth of its spread.
    EXPECT_LT((found.groups[i].cumulative_variance - expected.groups[i].cumulative_variance).cwiseAbs().maxCoeff(),
              1e-6);
    EXPECT_EQ(found.groups[i].k, expected.groups[i].k);
  }
  for (std::size_t i = 0; i < found.transitions.size(); ++i) {
    EXPECT_EQ(found.transitions[i].likeness.index, expected.transitions[i].likeness.index);
    EXPECT_EQ(found.transitions[i].changepoint.index, expected.transitions[i].changepoint.index);
  }
}

TEST(Degenerate, NotFiniteOrTooLarge) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<Demonstration> recordings = plain(3);
    recordings[1].q_h(17, 2) = bad;
    const auto found = analyze(recordings, few_replicates());
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, FailureCode::invalid_input);
    EXPECT_NE(found.error().detail.find(recordings[1].id), std::string::npos);
    EXPECT_THROW(moments(recordings[1].q_h), std::invalid_argument);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(2, 2);
    covariance(0, 0) = bad;
    EXPECT_THROW(principal_axes({1.0, Eigen::VectorXd::Zero(2), covariance}), std::invalid_argument);
    EXPECT_THROW(effective_subspace(covariance, Eigen::VectorXd::Zero(2)), std::invalid_argument);
    const SampleStatistics good{1.0, Eigen::VectorXd::Zero(2), Eigen::MatrixXd::Identity(2, 2)};
    for (const SampleStatistics& one : {SampleStatistics{1.0, good.mean, covariance},
                                        SampleStatistics{1.0, Eigen::Vector2d(0.0, bad), good.covariance}}) {
      EXPECT_THROW(log_likeness(one, good, 1e-4), std::invalid_argument);
      EXPECT_THROW(bhattacharyya_distance(good, one, 1e-4), std::invalid_argument);
    }
  }
  Demonstration still_clock = plain(1).front();
  const TransitionCurves curves = transition_curves(still_clock, {}).value();
  still_clock.time.setZero();
  EXPECT_THROW(transition(still_clock, curves, TransitionRule::likeness), std::invalid_argument);
}

TEST(Degenerate, AJointThatMovesInOneRecordingOnly) {
  std::vector<Demonstration> recordings = plain(5);
  for (std::size_t i = 1; i < recordings.size(); ++i) recordings[i].q_h.col(2).setConstant(0.1);
  expect_finite(analyze(recordings, few_replicates()).value());
}

}  // namespace
}  // namespace opponens::analysis
