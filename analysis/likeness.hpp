// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/result.hpp"
#include "core/synergies.hpp"

namespace opponens::analysis {

/// Normaliser of Eq. (1). The two differ by a constant in log L, so they move no minimum.
enum class Normaliser {
  gaussian_overlap,  ///< (2 pi)^n: the overlap integral of the two Gaussian densities
  printed,           ///< (2 pi)^(1 + 2n), as in the paper (docs/deviations.md)
};

/// log of the likeness, Eq. (1): with S = Sigma_A + Sigma_B + ridge I and d = mu_A - mu_B,
///   log L = -1/2 d' S^-1 d - 1/2 log|S| - (n/2) log 2 pi,
/// which is log of the integral of N(x; mu_A, Sigma_A) N(x; mu_B, Sigma_B) dx. By Cholesky, O(n^3); neither the
/// determinant nor the exponential is formed. ridge: variance added to the diagonal of S, squared unit of the samples.
/// Failure `degenerate` when S is not positive definite.
Result<double> log_likeness(const SampleStatistics& a, const SampleStatistics& b, double ridge,
                            Normaliser normaliser = Normaliser::gaussian_overlap);

/// Bhattacharyya distance D >= 0 of two Gaussians (Kailath 1967, doi:10.1109/TCOM.1967.1089532), a bounded relative of
/// the likeness: with M = (Sigma_A + Sigma_B)/2, each Sigma with ridge I added,
///   D = 1/8 d' M^-1 d + 1/2 log(|M| / sqrt(|Sigma_A| |Sigma_B|)).
/// Failure `degenerate` when a covariance is not positive definite.
Result<double> bhattacharyya_distance(const SampleStatistics& a, const SampleStatistics& b, double ridge);

/// exp(-D) in (0, 1]; 1 for equal distributions.
Result<double> bhattacharyya_coefficient(const SampleStatistics& a, const SampleStatistics& b, double ridge);

}  // namespace opponens::analysis
