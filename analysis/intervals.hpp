// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/rng.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Exact interval of a probability from independent trials (Clopper and Pearson 1934, doi:10.1093/biomet/26.4.404): it
/// holds the truth with at least the confidence. 0 <= events <= trials, trials > 0.
Interval proportion_interval(int events, int trials, double confidence);

/// How often each of c clusters occurs in one bootstrap resample: c draws with replacement. [c], sums to c.
Eigen::VectorXi resample_counts(int clusters, Rng& rng);

/// Quantile of a sorted sample at probability p, linear between the order statistics at (B + 1) p (Davison and Hinkley
/// 1997, Bootstrap Methods and their Application, section 2.2.1; Hyndman and Fan's type 6).
double bootstrap_quantile(const std::vector<double>& sorted, double p);

/// Basic bootstrap interval of a proportion on the logit: [2 l - l*_(1-a/2), 2 l - l*_(a/2)] mapped back, a = 1 -
/// confidence, l = logit(estimate), l* those of the replicates. The logit keeps it inside (0, 1); reflecting corrects
/// the bias of a cumulative variance, which the percentile interval doubles. Where the estimate or one of the two
/// quantiles is 0 or 1 (to 1e-9) there is no logit to reflect (a joint that moves in one recording only: resamples
/// without it have a share of 1); then the percentile interval, stretched to hold the estimate.
Interval basic_logit_interval(double estimate, std::vector<double> replicates, double confidence);

/// The plain percentile interval, for comparison: too narrow and shifted for a cumulative variance
/// (docs/deviations.md, 18).
Interval percentile_interval(std::vector<double> replicates, double confidence);

/// Cumulative-variance shares, [replicates x n], of resamples of whole clusters. clusters: moments of each, in the
/// space of the analysis, at least two. Cost per replicate O(c n^2 + n^3).
Eigen::MatrixXd bootstrap_cumulative_variance(const std::vector<SampleStatistics>& clusters, int replicates, Rng& rng);

/// Fewer clusters than this are too few to resample: with 5, basic_logit_interval holds the true share of the first 1,
/// 3, 6 synergies in 83, 34, 6 % of data sets instead of 95 %.
inline constexpr std::size_t kFewClusters = 20;

/// Intervals of the same shares by the jackknife on the logit: each cluster left out in turn gives a pseudo-value;
/// their mean, which corrects the bias of a share from few clusters, plus and minus Student's t of c - 1 degrees of
/// freedom times their standard error. Holds the shares above in 88, 84, 63 % with 5 clusters, 84 to 92 % with 12:
/// better, and still too narrow for late synergies (docs/deviations.md, 18). A share that is 1 with or without a
/// cluster has no logit: then the range of the shares. Source: Tukey 1958; Miller 1974, doi:10.1093/biomet/61.1.1. Cost
/// O(c n^3).
std::vector<Interval> jackknife_intervals(const std::vector<SampleStatistics>& clusters, double confidence);

/// One interval per number of synergies, [n]: basic_logit_interval, or jackknife_intervals for fewer than kFewClusters.
std::vector<Interval> cumulative_variance_intervals(const std::vector<SampleStatistics>& clusters, int replicates,
                                                    double confidence, Rng& rng);

/// Interval of a share of samples, sum(inside) / sum(total) over clusters. inside, total: [c], 0 <= inside <= total,
/// total > 0, at least two clusters. Most clusters are often wholly inside, so a resample tells too little: with 8 % of
/// 36 recordings imperfect, resampled intervals hold the truth in 75 % (basic on the logit) or 82 % (percentile) of
/// data sets instead of 95 %, and with all of them perfect they have no width. So, after Gaffke: each replicate weighs
/// whole clusters by independent Exp(1) (Rubin's Bayesian bootstrap) and adds one cluster of mean size that nobody saw,
/// wholly outside for the low end, wholly inside for the high end. Shares of 0 and 1 only give the exact
/// Clopper-Pearson interval of c trials; c perfect clusters [(a/2)^(1/c), 1], a = 1 - confidence. Holds its level for
/// independent clusters of equal size in all known cases (a conjecture, simulated in intervals_test); it is wide when
/// clusters are few (docs/deviations.md, 19). Source: Gaffke 2005, Mathematical Methods of Statistics 14(4);
/// Learned-Miller and Thomas 2019, arXiv:1905.06208; Rubin 1981, doi:10.1214/aos/1176345338.
Interval ratio_interval(const Eigen::VectorXd& inside, const Eigen::VectorXd& total, int replicates, double confidence,
                        Rng& rng);

}  // namespace opponens::analysis
