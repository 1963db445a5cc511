// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/statistics.hpp"

#include <cmath>
#include <string>

#include "core/require.hpp"

namespace opponens::analysis {

SampleStatistics moments(const Eigen::Ref<const Eigen::MatrixXd>& q, double weight) {
  require(q.rows() >= 1 && q.cols() >= 1, "moments: no samples");
  require(std::isfinite(weight) && weight > 0.0, [&] { return "moments: weight " + std::to_string(weight); });
  require(q.allFinite(), "moments: a sample is not finite");
  const auto samples = static_cast<double>(q.rows());
  SampleStatistics result;
  result.count = weight * samples;
  result.mean = q.colwise().mean().transpose();
  const Eigen::MatrixXd centred = q.rowwise() - result.mean.transpose();
  result.covariance = Eigen::MatrixXd::Zero(q.cols(), q.cols());
  result.covariance.selfadjointView<Eigen::Lower>().rankUpdate(centred.transpose(), 1.0 / samples);
  result.covariance.triangularView<Eigen::StrictlyUpper>() = result.covariance.transpose();
  return result;
}

SampleStatistics merge(const SampleStatistics& a, const SampleStatistics& b) {
  if (a.count == 0.0) return b;
  if (b.count == 0.0) return a;
  require(a.mean.size() == b.mean.size(), "merge: sets of different dimension");
  const double count = a.count + b.count;
  const double share = b.count / count;
  const Eigen::VectorXd delta = b.mean - a.mean;
  SampleStatistics result;
  result.count = count;
  result.mean = a.mean + share * delta;
  result.covariance =
      (1.0 - share) * a.covariance + share * b.covariance + (share * (1.0 - share)) * (delta * delta.transpose());
  return result;
}

SampleStatistics pooled(const std::vector<SampleStatistics>& parts) {
  require(!parts.empty(), "pooled: no sets");
  SampleStatistics result = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) result = merge(result, parts[i]);
  return result;
}

SampleStatistics scaled(const SampleStatistics& statistics, const Eigen::VectorXd& scale) {
  require(scale.size() == statistics.mean.size(), "scaled: scale and mean differ in length");
  require((scale.array() > 0.0).all() && scale.allFinite(), "scaled: a scale is not positive");
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  SampleStatistics result;
  result.count = statistics.count;
  result.mean = statistics.mean.cwiseProduct(inverse);
  result.covariance = inverse.asDiagonal() * statistics.covariance * inverse.asDiagonal();
  return result;
}

}  // namespace opponens::analysis
