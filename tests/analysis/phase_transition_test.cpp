// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/phase_transition.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "analysis/statistics.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

using test::recording;
using test::two_phases;

TEST(TransitionCurves, EqualNaiveRecomputation) {
  Rng rng = stream(12, "curves");
  const Demonstration demonstration = two_phases(90, 16, 0.45, 0.03, rng);
  const TransitionSettings settings;
  const TransitionCurves curves = transition_curves(demonstration, settings).value();
  ASSERT_EQ(curves.kept.size(), 16u);
  EXPECT_EQ(curves.first, 17);
  ASSERT_EQ(curves.log_likeness.size(), 90 - 2 * 17 + 1);
  const double ridge = settings.resolution * settings.resolution;
  const Eigen::MatrixXd r = ridge * Eigen::MatrixXd::Identity(16, 16);
  for (Eigen::Index i = 0; i < curves.log_likeness.size(); ++i) {
    const Eigen::Index t = curves.first + i;
    const SampleStatistics a = moments(demonstration.q_h.topRows(t));
    const SampleStatistics b = moments(demonstration.q_h.bottomRows(90 - t));
    EXPECT_NEAR(curves.log_likeness[i], log_likeness(a, b, ridge).value(), 1e-8) << t;
    const double cost = static_cast<double>(t) * std::log((a.covariance + r).determinant()) +
                        static_cast<double>(90 - t) * std::log((b.covariance + r).determinant());
    EXPECT_NEAR(curves.changepoint[i], cost, 1e-6 * std::abs(cost)) << t;
  }
  EXPECT_GT(curves.log_likeness.maxCoeff() - curves.log_likeness.minCoeff(), 1.0);
}

TEST(TransitionCurves, AFarZeroChangesNothing) {
  Rng rng = stream(13, "offset");
  Demonstration demonstration = two_phases(120, 8, 0.5, 0.01, rng);
  const TransitionCurves near = transition_curves(demonstration, {}).value();
  demonstration.q_h.array() += 1000.0;
  const TransitionCurves far = transition_curves(demonstration, {}).value();
  EXPECT_LT((near.log_likeness - far.log_likeness).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(TransitionCurves, SubspaceOnceAndNamed) {
  // As in real glove recordings: a dead sensor, DIP computed from PIP, an abduction that is the difference of two.
  Rng rng = stream(14, "singular");
  Demonstration plain = two_phases(150, 6, 0.4, 0.01, rng);
  Demonstration singular = plain;
  singular.q_h.conservativeResize(Eigen::NoChange, 9);
  singular.q_h.col(6).setConstant(0.2);
  singular.q_h.col(7) = 0.6 * plain.q_h.col(1);
  singular.q_h.col(8) = 0.5 * (plain.q_h.col(2) - plain.q_h.col(3));
  singular.joint_names = {"a", "pip", "b", "c", "d", "e", "dead", "dip", "dependent"};
  const TransitionCurves expected = transition_curves(plain, {}).value();
  const TransitionCurves found = transition_curves(singular, {}).value();
  EXPECT_EQ(found.dropped_channels, (std::vector<std::string>{"dead", "dip", "dependent"}));
  EXPECT_TRUE(found.log_likeness == expected.log_likeness);
  EXPECT_TRUE(found.changepoint == expected.changepoint);
}

TEST(TransitionCurves, PrintedNormaliserMovesNoMinimum) {
  Rng rng = stream(15, "printed");
  const Demonstration demonstration = two_phases(100, 5, 0.5, 0.01, rng);
  TransitionSettings printed;
  printed.normaliser = Normaliser::printed;
  const TransitionCurves a = transition_curves(demonstration, {}).value();
  const TransitionCurves b = transition_curves(demonstration, printed).value();
  const Eigen::VectorXd difference = a.log_likeness - b.log_likeness;
  EXPECT_NEAR(difference.minCoeff(), 3.0 * std::log(2.0 * M_PI), 1e-9);  // (1 + 2n - n)/2 = 3
  EXPECT_NEAR(difference.maxCoeff(), 3.0 * std::log(2.0 * M_PI), 1e-9);
}

TEST(TransitionCurves, RefusesWhatCannotBeSplit) {
  Rng rng = stream(16, "short");
  const Demonstration brief = recording("brief", test::normal_matrix(11, 5, rng));
  const auto too_short = transition_curves(brief, {});
  ASSERT_FALSE(too_short);
  EXPECT_EQ(too_short.error().code, FailureCode::too_few_samples);
  EXPECT_NE(too_short.error().detail.find("brief"), std::string::npos);
  EXPECT_TRUE(transition_curves(recording("enough", test::normal_matrix(12, 5, rng)), {}));

  const auto still = transition_curves(recording("still", Eigen::MatrixXd::Constant(100, 5, 0.3)), {});
  ASSERT_FALSE(still);
  EXPECT_EQ(still.error().code, FailureCode::degenerate);

  // Without a ridge, a channel that stands still in one phase makes that phase's covariance singular.
  Eigen::MatrixXd q = test::normal_matrix(60, 3, rng);
  q.col(2).head(40).setZero();
  TransitionSettings no_ridge;
  no_ridge.resolution = 0.0;
  const auto singular = transition_curves(recording("half", q), no_ridge);
  ASSERT_FALSE(singular);
  EXPECT_EQ(singular.error().code, FailureCode::degenerate);
  EXPECT_TRUE(transition_curves(recording("half", q), {}));

  TransitionSettings broken;
  broken.min_window = 1;
  EXPECT_THROW((void)transition_curves(brief, broken), std::invalid_argument);
}

TEST(Transition, IndexTimeAndFractionOfAJump) {
  // Two clouds far apart: both rules must cut exactly between them.
  Rng rng = stream(17, "jump");
  Eigen::MatrixXd q = 0.05 * test::normal_matrix(80, 4, rng);
  q.bottomRows(50).array() += 1.0;
  Demonstration demonstration = recording("jump", q);
  demonstration.time.array() += 5.0;
  const TransitionCurves curves = transition_curves(demonstration, {}).value();
  for (const TransitionRule rule : {TransitionRule::likeness, TransitionRule::changepoint}) {
    const Transition found = transition(demonstration, curves, rule);
    EXPECT_EQ(found.index, 30);
    EXPECT_DOUBLE_EQ(found.time_s, 5.0 + 30 * 0.02);
    EXPECT_NEAR(found.fraction, 30.0 / 79.0, 1e-12);
    EXPECT_EQ(found.method, rule);
  }
}

}  // namespace
}  // namespace opponens::analysis
