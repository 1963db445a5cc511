// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "storage/readers/resample.hpp"

#include <algorithm>
#include <cmath>

namespace opponens::storage {
namespace {

/// q at time t, linear between samples, the end values outside. hint: where the last call found its interval; t must
/// not decrease from call to call.
Eigen::RowVectorXd interpolate(const Samples& samples, double t, Eigen::Index& hint) {
  const Eigen::Index last = samples.time.size() - 1;
  if (t <= samples.time[0]) return samples.q.row(0);
  if (t >= samples.time[last]) return samples.q.row(last);
  while (samples.time[hint + 1] < t) ++hint;
  const double fraction = (t - samples.time[hint]) / (samples.time[hint + 1] - samples.time[hint]);
  // In this form a channel that stands still keeps its value to the last bit.
  return samples.q.row(hint) + fraction * (samples.q.row(hint + 1) - samples.q.row(hint));
}

}  // namespace

Samples resample(const Samples& samples, double rate) {
  const double start = samples.time[0];
  const double duration = samples.time[samples.time.size() - 1] - start;
  // A hair more than the duration, so that rounding does not lose the last sample of an already regular recording.
  const auto count = static_cast<Eigen::Index>(std::floor(duration * rate * (1.0 + 1e-12) + 1e-9)) + 1;
  Samples regular{Eigen::VectorXd(count), Eigen::MatrixXd(count, samples.q.cols())};
  Eigen::Index hint = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    regular.time[i] = start + static_cast<double>(i) / rate;
    regular.q.row(i) = interpolate(samples, regular.time[i], hint);
  }
  return regular;
}

Samples trim(const Samples& samples, const TrimRule& rule) {
  const Eigen::Index count = samples.time.size();
  Eigen::Index first = count;
  Eigen::Index last = -1;
  Eigen::Index before = 0;
  Eigen::Index after = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::RowVectorXd change = interpolate(samples, samples.time[i] + rule.window / 2.0, after) -
                                      interpolate(samples, samples.time[i] - rule.window / 2.0, before);
    if (change.cwiseAbs().maxCoeff() <= rule.speed * rule.window) continue;
    first = std::min(first, i);
    last = i;
  }
  if (last < first) return {Eigen::VectorXd(0), Eigen::MatrixXd(0, samples.q.cols())};
  return {samples.time.segment(first, last - first + 1), samples.q.middleRows(first, last - first + 1)};
}

}  // namespace opponens::storage
