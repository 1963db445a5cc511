// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/likeness.hpp"
#include "core/demonstration.hpp"
#include "core/result.hpp"

namespace opponens::analysis {

enum class TransitionRule {
  likeness,     ///< the paper's (section 4.1): argmin over t of L(Q_t-, Q_t+)
  changepoint,  ///< two-Gaussian maximum-likelihood split (docs/deviations.md)
};

struct TransitionSettings {
  double resolution = 0.0087;     ///< rad, of the sensor (CyberGlove: 0.5 degrees); its square is the ridge
  std::optional<int> min_window;  ///< samples on each side of a split; default: effective dof + 1, below which the
                                  ///< covariance of a window is singular whatever the hand does
  Normaliser normaliser = Normaliser::gaussian_overlap;
};

/// The costs of all admissible splits of one recording. Split t: Q- = samples [0, t), Q+ = samples [t, T).
struct TransitionCurves {
  int first = 0;                              ///< split of entry 0; entry i is split first + i
  Eigen::VectorXd log_likeness;               ///< log L(Q_t-, Q_t+), Eq. (1) in the effective subspace
  Eigen::VectorXd changepoint;                ///< n1 log|S1 + r^2 I| + n2 log|S2 + r^2 I|
  std::vector<int> kept;                      ///< channels of the effective subspace
  std::vector<std::string> dropped_channels;  ///< constant or linearly dependent ones
};

struct Transition {
  int index = 0;          ///< first sample of the grasp phase
  double time_s = 0.0;    ///< its time stamp
  double fraction = 0.0;  ///< (time - first time) / duration
  TransitionRule method = TransitionRule::likeness;
};

/// Both costs for every split, from prefix moments centred on the recording's mean: O(T n^2) for the moments and three
/// Cholesky factorisations of n x n per split. The effective subspace is found once, over the whole recording.
/// Failure `too_few_samples` when no split leaves min_window samples on both sides, `degenerate` when nothing moves.
Result<TransitionCurves> transition_curves(const Demonstration& demonstration, const TransitionSettings& settings);

/// The split of least cost under one rule; the earliest of equals.
Transition transition(const Demonstration& demonstration, const TransitionCurves& curves, TransitionRule rule);

}  // namespace opponens::analysis
