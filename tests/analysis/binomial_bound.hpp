// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/math/distributions/binomial.hpp>

namespace opponens::analysis::test {

inline constexpr double kFalseAlarm = 1e-4;

/// Whether a count is what Binomial(trials, p) gives, two-sided exact at the false-alarm rate.
inline bool is_binomial(double count, int trials, double p) {
  const boost::math::binomial distribution(trials, p);
  const double below = boost::math::cdf(distribution, count);
  const double above = count > 0.0 ? boost::math::cdf(boost::math::complement(distribution, count - 1)) : 1.0;
  return below >= 0.5 * kFalseAlarm && above >= 0.5 * kFalseAlarm;
}

}  // namespace opponens::analysis::test
