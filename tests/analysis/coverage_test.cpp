// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/coverage.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "analysis/statistics.hpp"
#include "tests/analysis/binomial_bound.hpp"
#include "tests/analysis/support.hpp"

namespace opponens::analysis {
namespace {

struct Cluster {
  SampleStatistics statistics;
  std::vector<Eigen::MatrixXd> samples;
  std::vector<double> weights;  // of the samples of each matrix
};

/// What analyze() does with the clusters of a group, of samples in memory.
BoxCoverage box_coverage(const std::vector<Cluster>& clusters, const CoverageSettings& settings, Rng& rng) {
  std::vector<SampleStatistics> statistics;
  for (const Cluster& cluster : clusters) statistics.push_back(cluster.statistics);
  const Walls all = make_walls(pooled(statistics), settings);
  std::vector<Walls> others;
  if (clusters.size() > 1) others = held_out_walls(statistics, settings, 1);
  std::vector<Tally> in_sample(clusters.size());
  std::vector<Tally> held_out(others.size());
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (std::size_t part = 0; part < clusters[c].samples.size(); ++part) {
      const Eigen::MatrixXd& x = clusters[c].samples[part];
      const double weight = clusters[c].weights[part];
      add(in_sample[c], count_inside(all, x, weight));
      if (!others.empty()) add(held_out[c], count_inside(others[c], x, weight));
    }
  }
  return coverage_of(all, in_sample, held_out, settings, rng);
}

std::vector<Cluster> clusters_of(const std::vector<Eigen::MatrixXd>& samples) {
  std::vector<Cluster> clusters;
  for (const Eigen::MatrixXd& part : samples) clusters.push_back({moments(part), {part}, {1.0}});
  return clusters;
}

CoverageSettings settings_for(int n, double resolution = 0.0) {
  CoverageSettings settings;
  settings.resolution = Eigen::VectorXd::Constant(n, resolution);
  return settings;
}

TEST(BoxCoverage, HeldOutOfAKnownDistribution) {
  // 100 clusters of 200 independent normals: each cluster's samples are new to the box of the others, so the held-out
  // count is Binomial(20000, 0.95) up to the box's own error (19,800 samples; < 0.1 %, allowed for by n = 5).
  Rng rng = stream(21, "held out");
  std::vector<Eigen::MatrixXd> parts;
  const Eigen::MatrixXd mixing = test::normal_matrix(5, 5, rng);
  for (int c = 0; c < 100; ++c) parts.push_back(test::normal_matrix(200, 5, rng) * mixing);
  Rng bootstrap = stream(21, "bootstrap");
  const BoxCoverage found = box_coverage(clusters_of(parts), settings_for(5), bootstrap);
  EXPECT_TRUE(test::is_binomial(std::round(*found.full.held_out * 20000), 20000, 0.95)) << *found.full.held_out;
  EXPECT_NEAR(found.full.nominal, 0.95, 1e-12);
  EXPECT_LT(found.full.interval->low, 0.95);
  EXPECT_GT(found.full.interval->high, 0.95);
  // The first k coordinates have their own nominal value, between 0.95 and 1.
  EXPECT_TRUE(test::is_binomial(std::round(*found.kept.held_out * 20000), 20000, found.kept.nominal))
      << *found.kept.held_out;
  EXPECT_GT(found.kept.nominal, 0.95);
}

TEST(BoxCoverage, HeldOutSeesWhatInSampleHides) {
  // Few recordings that each sit somewhere else: the box of the others does not hold the one left out.
  Rng rng = stream(22, "apart");
  std::vector<Eigen::MatrixXd> parts;
  for (int c = 0; c < 6; ++c) {
    const Eigen::RowVectorXd centre = test::normal_matrix(1, 8, rng);
    parts.push_back((0.1 * test::normal_matrix(50, 8, rng)).rowwise() + centre);
  }
  Rng bootstrap = stream(22, "bootstrap");
  const BoxCoverage found = box_coverage(clusters_of(parts), settings_for(8), bootstrap);
  EXPECT_GT(found.full.in_sample, 0.95);
  EXPECT_LT(*found.full.held_out, 0.5);
}

TEST(BoxCoverage, ZeroWidthAxesUseTheSensorResolution) {
  Rng rng = stream(23, "flat");
  Eigen::MatrixXd flat = test::normal_matrix(400, 4, rng);
  flat.col(2) = flat.col(0);
  flat.col(3).setConstant(0.25);
  std::vector<Eigen::MatrixXd> parts{flat.topRows(200), flat.bottomRows(200)};
  Rng bootstrap = stream(23, "bootstrap");
  const BoxCoverage found = box_coverage(clusters_of(parts), settings_for(4, 1e-3), bootstrap);
  // The two axes that are left are those of (sqrt(2) x0, x1), so the same samples must be inside, neither more nor
  // less.
  const Eigen::MatrixXd thin = flat.leftCols(2) * Eigen::Vector2d(std::sqrt(2.0), 1.0).asDiagonal();
  Rng other = stream(23, "bootstrap");
  EXPECT_EQ(
      *found.full.held_out,
      *box_coverage(clusters_of({thin.topRows(200), thin.bottomRows(200)}), settings_for(2), other).full.held_out);
  Rng exact = stream(23, "bootstrap");  // without a tolerance, rounding along the flat axes decides
  EXPECT_LT(*box_coverage(clusters_of(parts), settings_for(4), exact).full.held_out, *found.full.held_out);
  EXPECT_NEAR(found.full.nominal, 0.95, 1e-12);
  parts[1].col(3).array() += 0.01;  // ten resolutions off
  Rng again = stream(23, "bootstrap");
  EXPECT_EQ(*box_coverage(clusters_of(parts), settings_for(4, 1e-3), again).full.held_out, 0.0);
}

TEST(BoxCoverage, OneClusterHasNoHeldOut) {
  Rng rng = stream(24, "one");
  const BoxCoverage found = box_coverage(clusters_of({test::normal_matrix(100, 3, rng)}), settings_for(3), rng);
  EXPECT_FALSE(found.full.held_out);
  EXPECT_FALSE(found.full.interval);
  EXPECT_THROW(box_coverage({}, settings_for(3), rng), std::invalid_argument);
}

}  // namespace
}  // namespace opponens::analysis
