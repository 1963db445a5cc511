// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/subspace.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"

namespace opponens::analysis {
namespace {

constexpr double kRoundingShare = 1e-12;
constexpr double kConstantShare = 1e-20;
constexpr double kClearlyMore =
    1.0 + 1e-9;  // less is a tie, which rounding must not decide: the first channel is taken

}  // namespace

EffectiveSubspace effective_subspace(const Eigen::Ref<const Eigen::MatrixXd>& covariance,
                                     const Eigen::Ref<const Eigen::VectorXd>& resolution) {
  const Eigen::Index n = covariance.rows();
  require(covariance.cols() == n && resolution.size() == n, "effective_subspace: shapes differ");
  require(covariance.allFinite() && (resolution.array() >= 0.0).all(),
          "effective_subspace: covariance not finite or resolution negative");
  const Eigen::VectorXd variance = covariance.diagonal();
  const double smallest = std::max(kConstantShare * variance.maxCoeff(), 1e-300);
  const Eigen::VectorXd floor = resolution.array().square().max(kRoundingShare * variance.array()).max(smallest);
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(n, n);  // one column per taken channel
  Eigen::VectorXd remaining = variance;
  std::vector<bool> taken(static_cast<std::size_t>(n), false);
  EffectiveSubspace result;
  while (static_cast<Eigen::Index>(result.kept.size()) < n) {
    int pivot = -1;
    for (int j = 0; j < n; ++j) {
      if (taken[static_cast<std::size_t>(j)] || remaining[j] <= floor[j]) continue;
      if (pivot < 0 || remaining[j] * floor[pivot] > kClearlyMore * remaining[pivot] * floor[j]) pivot = j;
    }
    if (pivot < 0) break;
    const auto step = static_cast<Eigen::Index>(result.kept.size());
    const auto done = factor.leftCols(step);
    factor.col(step) = (covariance.col(pivot) - done * done.row(pivot).transpose()) / std::sqrt(remaining[pivot]);
    remaining -= factor.col(step).cwiseAbs2();
    taken[static_cast<std::size_t>(pivot)] = true;
    result.kept.push_back(pivot);
  }
  std::sort(result.kept.begin(), result.kept.end());
  for (int j = 0; j < n; ++j) {
    if (!taken[static_cast<std::size_t>(j)]) result.dropped.push_back(j);
  }
  return result;
}

std::vector<std::string> names_at(const std::vector<std::string>& names, const std::vector<int>& indices) {
  std::vector<std::string> result;
  result.reserve(indices.size());
  for (const int index : indices) result.push_back(names.at(static_cast<std::size_t>(index)));
  return result;
}

}  // namespace opponens::analysis
