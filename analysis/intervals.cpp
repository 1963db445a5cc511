// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/intervals.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

// A share within this of 0 or 1 is one: one step of one sensor in one of ten thousand samples is more.
constexpr double kShareFloor = 1e-9;

bool certain(double share) { return share <= kShareFloor || share >= 1.0 - kShareFloor; }

double logit(double p) {
  const double inside = std::clamp(p, kShareFloor, 1.0 - kShareFloor);
  return std::log(inside / (1.0 - inside));
}

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

double exponential(Rng& rng) { return -std::log1p(-rng.uniform()); }

/// Sums over each cluster's samples about a common centre, one column per cluster: weight, x, then the columns of x x'.
/// They add up over clusters, so a resample costs one multiplication and addition per number and drawn cluster.
Eigen::MatrixXd totals_about(const Eigen::VectorXd& centre, const std::vector<SampleStatistics>& clusters) {
  const Eigen::Index n = centre.size();
  Eigen::MatrixXd totals(1 + n + n * n, static_cast<Eigen::Index>(clusters.size()));
  for (Eigen::Index c = 0; c < totals.cols(); ++c) {
    const SampleStatistics& cluster = clusters[static_cast<std::size_t>(c)];
    const Eigen::VectorXd d = cluster.mean - centre;
    totals(0, c) = cluster.count;
    totals.col(c).segment(1, n) = cluster.count * d;
    totals.col(c).tail(n * n).reshaped(n, n) = cluster.count * (cluster.covariance + d * d.transpose());
  }
  return totals;
}

/// The moments that such sums belong to; the mean is relative to the centre.
SampleStatistics statistics_of(const Eigen::VectorXd& totals, Eigen::Index n) {
  SampleStatistics result;
  result.count = totals[0];
  result.mean = totals.segment(1, n) / result.count;
  result.covariance = totals.tail(n * n).reshaped(n, n) / result.count - result.mean * result.mean.transpose();
  return result;
}

void check(double confidence, std::size_t replicates) {
  require(confidence > 0.0 && confidence < 1.0, "interval: confidence must be in (0, 1)");
  require(replicates >= 2, "interval: at least 2 bootstrap replicates");
}

}  // namespace

Interval proportion_interval(int events, int trials, double confidence) {
  require(trials > 0 && events >= 0 && events <= trials, "proportion_interval: 0 <= events <= trials, trials > 0");
  require(confidence > 0.0 && confidence < 1.0, "proportion_interval: confidence must be in (0, 1)");
  using Binomial = boost::math::binomial_distribution<double>;
  const double tail = 0.5 * (1.0 - confidence);
  return {Binomial::find_lower_bound_on_p(trials, events, tail), Binomial::find_upper_bound_on_p(trials, events, tail)};
}

Eigen::VectorXi resample_counts(int clusters, Rng& rng) {
  require(clusters >= 2, "bootstrap: at least 2 clusters");
  Eigen::VectorXi counts = Eigen::VectorXi::Zero(clusters);
  for (int draw = 0; draw < clusters; ++draw) {
    ++counts[static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(clusters)))];
  }
  return counts;
}

double bootstrap_quantile(const std::vector<double>& sorted, double p) {
  require(!sorted.empty() && p >= 0.0 && p <= 1.0, "bootstrap_quantile: empty sample, or p outside [0, 1]");
  const auto size = static_cast<double>(sorted.size());
  const double rank = std::clamp((size + 1.0) * p, 1.0, size) - 1.0;
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double part = rank - static_cast<double>(below);
  return sorted[below] + part * (sorted[above] - sorted[below]);
}

Interval percentile_interval(std::vector<double> replicates, double confidence) {
  check(confidence, replicates.size());
  std::sort(replicates.begin(), replicates.end());
  const double tail = 0.5 * (1.0 - confidence);
  return {bootstrap_quantile(replicates, tail), bootstrap_quantile(replicates, 1.0 - tail)};
}

Interval basic_logit_interval(double estimate, std::vector<double> replicates, double confidence) {
  const Interval plain = percentile_interval(replicates, confidence);
  if (certain(estimate) || certain(plain.low) || certain(plain.high)) {
    return {std::min(estimate, plain.low), std::max(estimate, plain.high)};
  }
  std::transform(replicates.begin(), replicates.end(), replicates.begin(), logit);
  std::sort(replicates.begin(), replicates.end());
  const double tail = 0.5 * (1.0 - confidence);
  const double centre = 2.0 * logit(estimate);
  return {logistic(centre - bootstrap_quantile(replicates, 1.0 - tail)),
          logistic(centre - bootstrap_quantile(replicates, tail))};
}

Eigen::MatrixXd bootstrap_cumulative_variance(const std::vector<SampleStatistics>& clusters, int replicates, Rng& rng) {
  require(replicates >= 2, "bootstrap: at least 2 replicates");
  require(clusters.size() >= 2, "bootstrap: at least 2 clusters");
  const Eigen::Index n = clusters.front().mean.size();
  const Eigen::MatrixXd totals = totals_about(pooled(clusters).mean, clusters);
  Eigen::MatrixXd shares(replicates, n);
  for (int replicate = 0; replicate < replicates; ++replicate) {
    const Eigen::VectorXi counts = resample_counts(static_cast<int>(clusters.size()), rng);
    Eigen::VectorXd drawn = Eigen::VectorXd::Zero(totals.rows());
    for (Eigen::Index c = 0; c < counts.size(); ++c) {
      if (counts[c] != 0) drawn += static_cast<double>(counts[c]) * totals.col(c);
    }
    shares.row(replicate) = cumulative_variance(principal_axes(statistics_of(drawn, n)).variance).transpose();
  }
  return shares;
}

std::vector<Interval> jackknife_intervals(const std::vector<SampleStatistics>& clusters, double confidence) {
  check(confidence, clusters.size());
  const auto size = static_cast<Eigen::Index>(clusters.size());
  const Eigen::VectorXd estimate = cumulative_variance(principal_axes(pooled(clusters)).variance);
  Eigen::MatrixXd without(size, estimate.size());
  for (Eigen::Index c = 0; c < size; ++c) {
    std::vector<SampleStatistics> others = clusters;
    others.erase(others.begin() + c);
    without.row(c) = cumulative_variance(principal_axes(pooled(others)).variance).transpose();
  }
  const auto count = static_cast<double>(size);
  const double t = boost::math::quantile(boost::math::students_t(count - 1.0), 0.5 + 0.5 * confidence);
  std::vector<Interval> intervals;
  for (Eigen::Index i = 0; i < estimate.size(); ++i) {
    const double low = std::min(estimate[i], without.col(i).minCoeff());
    const double high = std::max(estimate[i], without.col(i).maxCoeff());
    if (certain(low) || certain(high)) {
      intervals.push_back({low, high});
      continue;
    }
    const Eigen::ArrayXd pseudo = count * logit(estimate[i]) - (count - 1.0) * without.col(i).unaryExpr(&logit).array();
    const double error = std::sqrt((pseudo - pseudo.mean()).square().sum() / (count * (count - 1.0)));
    intervals.push_back({logistic(pseudo.mean() - t * error), logistic(pseudo.mean() + t * error)});
  }
  return intervals;
}

std::vector<Interval> cumulative_variance_intervals(const std::vector<SampleStatistics>& clusters, int replicates,
                                                    double confidence, Rng& rng) {
  if (clusters.size() < kFewClusters) return jackknife_intervals(clusters, confidence);
  const Eigen::VectorXd estimate = cumulative_variance(principal_axes(pooled(clusters)).variance);
  const Eigen::MatrixXd shares = bootstrap_cumulative_variance(clusters, replicates, rng);
  std::vector<Interval> intervals;
  for (Eigen::Index i = 0; i < estimate.size(); ++i) {
    const Eigen::VectorXd column = shares.col(i);
    intervals.push_back(basic_logit_interval(estimate[i], {column.begin(), column.end()}, confidence));
  }
  return intervals;
}

Interval ratio_interval(const Eigen::VectorXd& inside, const Eigen::VectorXd& total, int replicates, double confidence,
                        Rng& rng) {
  check(confidence, static_cast<std::size_t>(std::max(replicates, 0)));
  require(inside.size() == total.size() && inside.size() >= 2, "ratio_interval: at least 2 clusters");
  require((total.array() > 0.0).all() && (inside.array() >= 0.0).all() && (inside.array() <= total.array()).all(),
          "ratio_interval: a cluster has no samples, or more inside than it has");
  const double unseen = total.mean();
  std::vector<double> low;
  std::vector<double> high;
  for (int replicate = 0; replicate < replicates; ++replicate) {
    Eigen::VectorXd weight(total.size());
    for (double& one : weight) one = exponential(rng);
    const double added = exponential(rng) * unseen;
    const double part = weight.dot(inside);
    const double all = weight.dot(total) + added;
    low.push_back(part / all);
    high.push_back((part + added) / all);
  }
  std::sort(low.begin(), low.end());
  std::sort(high.begin(), high.end());
  const double tail = 0.5 * (1.0 - confidence);
  return {bootstrap_quantile(low, tail), bootstrap_quantile(high, 1.0 - tail)};
}

}  // namespace opponens::analysis
