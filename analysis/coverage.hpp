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

/// What a cluster (a subject, or a recording) adds to a group.
struct Cluster {
  SampleStatistics statistics;           ///< scaled space
  std::vector<Eigen::MatrixXd> samples;  ///< each [T x n] scaled, row = sample
  std::vector<double> weights;           ///< of the samples of each matrix
};

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

/// Coverage in sample and held out. A coordinate counts as inside axis u when |y| <= max(half width, tolerance) with
/// tolerance = sqrt(sum_j u_j^2 r_j^2), one sensor resolution along the axis: an axis of zero width would otherwise
/// exclude every sample for its rounding. Held out: mean, axes, k, effective dof and widths are those of the other
/// clusters. Cost O(samples n^2 + clusters (clusters n^2 + n^3)).
BoxCoverage box_coverage(const std::vector<Cluster>& clusters, const CoverageSettings& settings, Rng& rng);

}  // namespace opponens::analysis
