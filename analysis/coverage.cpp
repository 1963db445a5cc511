// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "analysis/pca.hpp"
#include "analysis/statistics.hpp"
#include "analysis/subspace.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

Tally sum_of(const std::vector<Tally>& parts) {
  Tally sum;
  for (const Tally& part : parts) add(sum, part);
  return sum;
}

/// Clusters [begin, end) of a tree that is halved down to single ones; outside: all the others.
struct Branch {
  std::size_t begin;
  std::size_t end;
  SampleStatistics outside;
};

class LeaveOneOut {
 public:
  LeaveOneOut(const std::vector<SampleStatistics>& clusters, const CoverageSettings& settings)
      : clusters_(clusters), settings_(settings), walls_(clusters.size()) {}

  void descend(const Branch& branch, int threads) {
    if (branch.end - branch.begin == 1) {
      walls_[branch.begin] = make_walls(branch.outside, settings_);
      return;
    }
    const std::size_t middle = branch.begin + (branch.end - branch.begin) / 2;
    const Branch left{branch.begin, middle, merge(branch.outside, pooled_range(middle, branch.end))};
    const Branch right{middle, branch.end, merge(branch.outside, pooled_range(branch.begin, middle))};
    const auto policy = threads > 1 ? std::launch::async : std::launch::deferred;
    auto other = std::async(policy, [&] { descend(left, threads / 2); });
    descend(right, threads - threads / 2);
    other.get();
  }
  std::vector<Walls> take() { return std::move(walls_); }

 private:
  SampleStatistics pooled_range(std::size_t begin, std::size_t end) const {
    PairwiseMerge tree;
    for (std::size_t i = begin; i < end; ++i) tree.add(clusters_[i]);
    return tree.result();
  }

  const std::vector<SampleStatistics>& clusters_;
  const CoverageSettings& settings_;
  std::vector<Walls> walls_;
};

}  // namespace

void add(Tally& sum, const Tally& part) {
  sum.total += part.total;
  sum.full += part.full;
  sum.kept += part.kept;
}

Walls make_walls(const SampleStatistics& statistics, const CoverageSettings& settings) {
  const SynergyBasis basis = principal_axes(statistics);
  Walls walls;
  walls.k = synergies_needed(basis.variance, settings.beta);
  walls.dof_effective = std::max(1, effective_subspace(statistics.covariance, settings.resolution).dof());
  const Eigen::VectorXd tolerance = (basis.axes.cwiseAbs2().transpose() * settings.resolution.cwiseAbs2()).cwiseSqrt();
  walls.reach =
      box_half_width(basis.variance, settings.alpha, settings.root, walls.dof_effective, walls.k).cwiseMax(tolerance);
  walls.mean = basis.mean;
  walls.axes = basis.axes;
  return walls;
}

std::vector<Walls> held_out_walls(const std::vector<SampleStatistics>& clusters, const CoverageSettings& settings,
                                  int threads) {
  require(clusters.size() >= 2 && threads >= 1, "held_out_walls: at least 2 clusters and 1 thread");
  LeaveOneOut tree(clusters, settings);
  tree.descend({0, clusters.size(), {}}, threads);
  return tree.take();
}

Tally count_inside(const Walls& walls, const Eigen::Ref<const Eigen::MatrixXd>& x, double weight) {
  const Eigen::MatrixXd y = (x.rowwise() - walls.mean.transpose()) * walls.axes;
  Eigen::VectorXd excess = Eigen::VectorXd::Constant(x.rows(), -walls.reach[0]);
  const auto inside = [&] { return weight * static_cast<double>((excess.array() <= 0.0).count()); };
  Tally tally;
  tally.total = weight * static_cast<double>(x.rows());
  for (Eigen::Index axis = 0; axis < y.cols(); ++axis) {
    excess = excess.array().max(y.col(axis).array().abs() - walls.reach[axis]).matrix();
    if (axis + 1 == walls.k) tally.kept = inside();
  }
  tally.full = inside();
  return tally;
}

BoxCoverage coverage_of(const Walls& all, const std::vector<Tally>& in_sample, const std::vector<Tally>& held_out,
                        const CoverageSettings& settings, Rng& rng) {
  BoxCoverage result;
  const Tally seen = sum_of(in_sample);
  result.full.in_sample = seen.full / seen.total;
  result.kept.in_sample = seen.kept / seen.total;
  const double axis = axis_probability(settings.alpha, settings.root, all.dof_effective, all.k);
  result.full.nominal = std::pow(axis, all.dof_effective);
  result.kept.nominal = std::pow(axis, all.k);
  if (held_out.empty()) return result;

  const auto size = static_cast<Eigen::Index>(held_out.size());
  Eigen::VectorXd total(size);
  Eigen::VectorXd full(size);
  Eigen::VectorXd kept(size);
  for (Eigen::Index c = 0; c < size; ++c) {
    const Tally& tally = held_out[static_cast<std::size_t>(c)];
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
