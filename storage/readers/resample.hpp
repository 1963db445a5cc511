// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Not a public header: what happens to the samples of one recording between file and Demonstration.

#include <optional>

#include <Eigen/Core>

#include "storage/readers/source.hpp"

namespace opponens::storage {

struct Samples {
  Eigen::VectorXd time;  ///< [T] s, strictly increasing
  Eigen::MatrixXd q;     ///< [T x n] rad
};

/// Linear interpolation at time[0] + i / rate, up to the last sample. The caller bounds how many that are.
Samples resample(const Samples& samples, double rate);

/// The samples from the first to the last at which the hand moves (TrimRule); none when it never does.
Samples trim(const Samples& samples, const TrimRule& rule);

}  // namespace opponens::storage
