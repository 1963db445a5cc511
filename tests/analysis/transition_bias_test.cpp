// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// How far the two transition rules miss a known change. The figures are printed and recorded; what is asserted is the
// claim of docs/deviations.md: the change-point rule is the less biased of the two.

#include <cmath>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

#include "analysis/phase_transition.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

struct Errors {
  double mean = 0.0;
  double absolute = 0.0;  ///< mean absolute
};

struct Both {
  Errors likeness;
  Errors changepoint;
  int changepoint_nearer = 0;  ///< recordings
  int likeness_nearer = 0;
};

/// Sign test: were the two rules equally good, the recordings in which a rule is the nearer one (ties left out) would
/// be Binomial(n, 1/2). One-sided exact bound at 1e-4.
bool nearer(int wins, int losses) {
  const boost::math::binomial even(wins + losses, 0.5);
  return wins > boost::math::quantile(boost::math::complement(even, 1e-4));
}

Both measure(const std::vector<Demonstration>& recordings) {
  Both both;
  const auto count = static_cast<double>(recordings.size());
  for (const Demonstration& recording : recordings) {
    const TransitionCurves curves = transition_curves(recording, {}).value();
    const double duration = recording.time[recording.time.size() - 1];
    const auto add = [&](TransitionRule rule, Errors& errors) -> double {
      const double error = (transition(recording, curves, rule).time_s - *recording.known_transition) / duration;
      errors.mean += error / count;
      errors.absolute += std::abs(error) / count;
      return std::abs(error);
    };
    const double likeness = add(TransitionRule::likeness, both.likeness);
    const double changepoint = add(TransitionRule::changepoint, both.changepoint);
    both.changepoint_nearer += changepoint < likeness ? 1 : 0;
    both.likeness_nearer += likeness < changepoint ? 1 : 0;
  }
  return both;
}

void print(const std::string& title, const Both& both) {
  std::cout << title << ": likeness bias " << both.likeness.mean << ", mean |error| " << both.likeness.absolute
            << "; changepoint bias " << both.changepoint.mean << ", mean |error| " << both.changepoint.absolute << "\n";
}

TEST(TransitionBias, TwoMinimumJerkLegs) {
  for (const double corner : {0.3, 0.4, 0.5, 0.6, 0.7}) {
    std::vector<Demonstration> recordings;
    for (int i = 0; i < 100; ++i) {
      Rng rng = test::numbered_stream(30, "legs/", static_cast<int>(100 * corner) * 1000 + i);
      recordings.push_back(test::two_phases(100, 16, corner, 0.0044, rng));
    }
    const Both both = measure(recordings);
    print(std::string("corner at ").append(std::to_string(corner)), both);
    EXPECT_TRUE(nearer(both.changepoint_nearer, both.likeness_nearer)) << both.changepoint_nearer << " of 100";
    EXPECT_FALSE(nearer(both.likeness_nearer, both.changepoint_nearer));
  }
}

TEST(TransitionBias, SimulatedGrasps) {
  std::vector<Demonstration> recordings;
  for (Demonstration& recording : simulate(test::human_model(), {}, 1)) {
    if (recording.known_transition) recordings.push_back(std::move(recording));
  }
  const Both both = measure(recordings);
  print("simulated grasps", both);
  EXPECT_TRUE(nearer(both.changepoint_nearer, both.likeness_nearer)) << both.changepoint_nearer << " of 180";
  EXPECT_FALSE(nearer(both.likeness_nearer, both.changepoint_nearer));
}

}  // namespace
}  // namespace opponens::analysis
