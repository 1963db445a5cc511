// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Bias and spread of the two transition rules where the change is known. The figures are printed and recorded in
// docs/results.md. Asserted is what docs/deviations.md and docs/algorithms/phase_transition.md say: the likeness rule
// is biased, the change-point rule is the nearer one and stays within a tenth of the movement.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/distributions/binomial.hpp>

#include "analysis/phase_transition.hpp"
#include "tests/analysis/binomial_bound.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

using Errors = std::vector<double>;  // found - known, share of the movement; one per recording

struct Both {
  Errors likeness;
  Errors changepoint;
};

int count_if(const Errors& errors, double low, double high) {
  return static_cast<int>(std::count_if(errors.begin(), errors.end(), [&](double e) { return e > low && e < high; }));
}

/// Sign test. Null: a recording's error is as often positive as negative, so the positive ones (zeros left out) are
/// Binomial(n, 1/2). True when that is refused, two-sided, false-alarm rate 1e-4.
bool biased(const Errors& errors) {
  const int below = count_if(errors, -2.0, 0.0);
  const int above = count_if(errors, 0.0, 2.0);
  return !test::is_binomial(above, below + above, 0.5);
}

/// Null: a rule comes within a tenth of the movement with probability p or more. True when that stands at 1e-4.
bool near_with_probability(const Errors& errors, double p) {
  const boost::math::binomial distribution(static_cast<double>(errors.size()), p);
  return boost::math::cdf(distribution, count_if(errors, -0.1, 0.1)) >= test::kFalseAlarm;
}

/// Sign test. Null: neither rule is the nearer one more often. True when a is the nearer one, one-sided, 1e-4.
bool nearer(const Errors& a, const Errors& b) {
  int wins = 0;
  int losses = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    wins += std::abs(a[i]) < std::abs(b[i]) ? 1 : 0;
    losses += std::abs(b[i]) < std::abs(a[i]) ? 1 : 0;
  }
  const boost::math::binomial even(wins + losses, 0.5);
  return wins > boost::math::quantile(boost::math::complement(even, test::kFalseAlarm));
}

Both measure(const std::vector<Demonstration>& recordings) {
  Both both;
  for (const Demonstration& recording : recordings) {
    const TransitionCurves curves = transition_curves(recording, {}).value();
    const double duration = recording.time[recording.time.size() - 1];
    const auto error = [&](TransitionRule rule) {
      return (transition(recording, curves, rule).time_s - *recording.known_transition) / duration;
    };
    both.likeness.push_back(error(TransitionRule::likeness));
    both.changepoint.push_back(error(TransitionRule::changepoint));
  }
  return both;
}

void print(const char* rule, const Errors& errors) {
  const Eigen::Map<const Eigen::ArrayXd> e(errors.data(), static_cast<Eigen::Index>(errors.size()));
  std::cout << "  " << rule << ": bias " << e.mean() << ", spread (standard deviation) "
            << std::sqrt((e - e.mean()).square().mean()) << ", mean |error| " << e.abs().mean() << "\n";
}

void print(const std::string& title, const Both& both) {
  std::cout << title << "\n";
  print("likeness", both.likeness);
  print("changepoint", both.changepoint);
}

void expect_what_is_documented(const Both& both, double near) {
  EXPECT_TRUE(nearer(both.changepoint, both.likeness));
  EXPECT_FALSE(nearer(both.likeness, both.changepoint));
  EXPECT_TRUE(near_with_probability(both.changepoint, near));
  EXPECT_FALSE(near_with_probability(both.likeness, near));
}

TEST(TransitionBias, TwoMinimumJerkLegs) {
  for (const double corner : {0.3, 0.4, 0.5, 0.6, 0.7}) {
    SCOPED_TRACE(corner);
    std::vector<Demonstration> recordings;
    for (int i = 0; i < 100; ++i) {
      Rng rng = test::numbered_stream(30, "legs/", static_cast<int>(100 * corner) * 1000 + i);
      recordings.push_back(test::two_phases(100, 16, corner, 0.0044, rng));
    }
    const Both both = measure(recordings);
    print("corner at " + std::to_string(corner), both);
    expect_what_is_documented(both, 0.9);
    if (corner == 0.5) {
      // By symmetry without bias, but the minimum lies on either side: hardly any comes within a tenth.
      EXPECT_FALSE(biased(both.likeness));
      EXPECT_FALSE(near_with_probability(both.likeness, 0.2));
    } else {
      EXPECT_TRUE(biased(both.likeness));
      EXPECT_EQ(count_if(both.likeness, 0.0, 1.0) > 50, corner > 0.5) << "away from the middle of the movement";
    }
  }
}

TEST(TransitionBias, SimulatedGrasps) {
  std::vector<Demonstration> recordings;
  for (Demonstration& recording : simulate(test::human_model(), {}, 1)) {
    if (recording.known_transition) recordings.push_back(std::move(recording));
  }
  const Both both = measure(recordings);
  print("simulated grasps", both);
  expect_what_is_documented(both, 0.6);
  EXPECT_TRUE(biased(both.likeness));
  EXPECT_TRUE(biased(both.changepoint)) << "late: +0.08 of the movement";
}

}  // namespace
}  // namespace opponens::analysis
