// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/coverage.hpp"

#include <cmath>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

/// All n axes of one basis with what counts as inside each.
struct Walls {
  SynergyBasis basis;
  Eigen::VectorXd reach;  ///< [n] max(half width, tolerance)
  int k = 1;
  int dof_effective = 1;
};

struct Tally {
  double total = 0.0;
  double full = 0.0;
  double kept = 0.0;
};

Walls make_walls(const SampleStatistics& statistics, const CoverageSettings& settings) {
  Walls walls;
  walls.basis = principal_axes(statistics);
  walls.k = synergies_needed(walls.basis.variance, settings.beta);
  walls.dof_effective = std::max(1, effective_subspace(statistics.covariance, settings.resolution).dof());
  const Eigen::VectorXd tolerance =
      (walls.basis.axes.cwiseAbs2().transpose() * settings.resolution.cwiseAbs2()).cwiseSqrt();
  walls.reach = box_half_width(walls.basis.variance, settings.alpha, settings.root, walls.dof_effective, walls.k)
                    .cwiseMax(tolerance);
  return walls;
}

Tally count_inside(const Walls& walls, const Cluster& cluster) {
  Tally tally;
  for (std::size_t part = 0; part < cluster.samples.size(); ++part) {
    const Eigen::MatrixXd y =
        ((cluster.samples[part].rowwise() - walls.basis.mean.transpose()) * walls.basis.axes).cwiseAbs();
    const double weight = cluster.weights[part];
    for (Eigen::Index row = 0; row < y.rows(); ++row) {
      const auto inside = y.row(row).array() <= walls.reach.transpose().array();
      tally.total += weight;
      if (!inside.head(walls.k).all()) continue;
      tally.kept += weight;
      if (inside.all()) tally.full += weight;
    }
  }
  return tally;
}

SampleStatistics others(const std::vector<Cluster>& clusters, std::size_t left_out) {
  SampleStatistics result;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (c != left_out) result = merge(result, clusters[c].statistics);
  }
  return result;
}

void check(const std::vector<Cluster>& clusters, const CoverageSettings& settings) {
  require(!clusters.empty(), "box_coverage: no clusters");
  for (const Cluster& cluster : clusters) {
    require(cluster.samples.size() == cluster.weights.size() && !cluster.samples.empty(),
            "box_coverage: a cluster without samples, or without a weight for each");
    require(cluster.statistics.mean.size() == settings.resolution.size(),
            "box_coverage: resolution and samples differ in size");
  }
}

}  // namespace

BoxCoverage box_coverage(const std::vector<Cluster>& clusters, const CoverageSettings& settings, Rng& rng) {
  check(clusters, settings);
  const auto size = static_cast<Eigen::Index>(clusters.size());
  const Walls walls = make_walls(others(clusters, clusters.size()), settings);
  BoxCoverage result;
  Tally in_sample;
  for (const Cluster& cluster : clusters) {
    const Tally tally = count_inside(walls, cluster);
    in_sample.total += tally.total;
    in_sample.full += tally.full;
    in_sample.kept += tally.kept;
  }
  result.full.in_sample = in_sample.full / in_sample.total;
  result.kept.in_sample = in_sample.kept / in_sample.total;
  const double axis = axis_probability(settings.alpha, settings.root, walls.dof_effective, walls.k);
  result.full.nominal = std::pow(axis, walls.dof_effective);
  result.kept.nominal = std::pow(axis, walls.k);
  if (size < 2) return result;

  Eigen::VectorXd total(size);
  Eigen::VectorXd full(size);
  Eigen::VectorXd kept(size);
  for (Eigen::Index c = 0; c < size; ++c) {
    const auto index = static_cast<std::size_t>(c);
    const Tally tally = count_inside(make_walls(others(clusters, index), settings), clusters[index]);
    total[c] = tally.total;
    full[c] = tally.full;
    kept[c] = tally.kept;
  }
  result.full.held_out = full.sum() / total.sum();
  result.kept.held_out = kept.sum() / total.sum();
  result.full.interval = ratio_interval(full, total, settings.replicates, settings.confidence, rng);
  result.kept.interval = ratio_interval(kept, total, settings.replicates, settings.confidence, rng);
  return result;
}

}  // namespace opponens::analysis
