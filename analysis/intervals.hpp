// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/rng.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// How often each of c clusters occurs in one bootstrap resample: c draws with replacement. [c], sums to c.
Eigen::VectorXi resample_counts(int clusters, Rng& rng);

/// Quantile of a sorted sample at probability p, linear between the order statistics at (B + 1) p (Davison and Hinkley
/// 1997, Bootstrap Methods and their Application, section 2.2.1; Hyndman and Fan's type 6).
double bootstrap_quantile(const std::vector<double>& sorted, double p);

/// Basic bootstrap interval of a proportion on the logit: [2 l - l*_(1-a/2), 2 l - l*_(a/2)] mapped back, a = 1 -
/// confidence, l = logit(estimate), l* those of the replicates. The logit keeps it inside (0, 1); reflecting corrects
/// the bias of a cumulative variance, which the percentile interval doubles. An estimate of 0 or 1 gives itself.
Interval basic_logit_interval(double estimate, std::vector<double> replicates, double confidence);

/// The plain percentile interval, for comparison: too narrow and shifted for a cumulative variance
/// (docs/deviations.md).
Interval percentile_interval(std::vector<double> replicates, double confidence);

/// Cumulative-variance shares, [replicates x n], of resamples of whole clusters. clusters: moments of each, in the
/// space of the analysis, at least two. Cost per replicate O(c n^2 + n^3).
Eigen::MatrixXd bootstrap_cumulative_variance(const std::vector<SampleStatistics>& clusters, int replicates, Rng& rng);

/// One basic_logit_interval per number of synergies, [n].
std::vector<Interval> cumulative_variance_intervals(const std::vector<SampleStatistics>& clusters, int replicates,
                                                    double confidence, Rng& rng);

/// Interval of sum(inside) / sum(total) over clusters, by the same bootstrap. inside, total: [c], total > 0.
Interval ratio_interval(const Eigen::VectorXd& inside, const Eigen::VectorXd& total, int replicates, double confidence,
                        Rng& rng);

}  // namespace opponens::analysis
