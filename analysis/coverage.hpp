// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/intervals.hpp"
#include "analysis/synergy_box.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

/// Share of the samples inside, beside what a normal distribution would give.
struct Coverage {
  double in_sample = 0.0;
  std::optional<double> held_out;    ///< one cluster left out at a time; nullopt with a single cluster
  std::optional<Interval> interval;  ///< of held_out, over clusters (ratio_interval)
  double nominal = 0.0;              ///< axis_probability to the power of the number of axes with width
};

struct BoxCoverage {
  Coverage full;  ///< of the n-box: all axes
  Coverage kept;  ///< of the first k coordinates
};

struct CoverageSettings {
  double alpha = 0.05;  ///< fraction outside the n-box
  double beta = 0.05;   ///< fraction of variance left out
  BoxRoot root = BoxRoot::n;
  Eigen::VectorXd resolution;  ///< [n] scaled, of the sensors: the tolerance below, and of the effective subspace
  int replicates = 200;        ///< of the bootstrap
  double confidence = 0.95;    ///< of the interval
};

/// What counts as inside: all n axes of one basis, and how far along each: |y| <= max(half width, tolerance) with
/// tolerance = sqrt(sum_j u_j^2 r_j^2), one sensor resolution along axis u; an axis of zero width would otherwise
/// exclude every sample for its rounding.
struct Walls {
  Eigen::VectorXd mean;   ///< [n]
  Eigen::MatrixXd axes;   ///< [n x n] orthonormal columns
  Eigen::VectorXd reach;  ///< [n] max(half width, tolerance)
  int k = 1;
  int dof_effective = 1;
};

/// Sums of weights of samples.
struct Tally {
  double total = 0.0;
  double full = 0.0;  ///< inside along all axes
  double kept = 0.0;  ///< inside along the first k
};

void add(Tally& sum, const Tally& part);

Walls make_walls(const SampleStatistics& statistics, const CoverageSettings& settings);

/// For each of at least two clusters the walls of all others (mean, axes, k, effective dof and widths are theirs),
/// merged in a fixed tree: O(c (log c n^2 + n^3)) on the given number of threads, on which the result does not depend.
std::vector<Walls> held_out_walls(const std::vector<SampleStatistics>& clusters, const CoverageSettings& settings,
                                  int threads);

/// x: [T x n] scaled, row = sample, each of the given weight.
Tally count_inside(const Walls& walls, const Eigen::Ref<const Eigen::MatrixXd>& x, double weight);

/// Coverage from counts per cluster. held_out: empty with a single cluster. all: the walls of all samples.
BoxCoverage coverage_of(const Walls& all, const std::vector<Tally>& in_sample, const std::vector<Tally>& held_out,
                        const CoverageSettings& settings, Rng& rng);

}  // namespace opponens::analysis
