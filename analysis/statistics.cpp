// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <string>
#include <utility>

#include "analysis/moment_kernel.hpp"
#include "core/require.hpp"

namespace opponens::analysis {

namespace {

void require_finite(const SampleStatistics& found, const SampleView& samples) {
  if (found.covariance.allFinite() && found.mean.allFinite()) return;
  for (Eigen::Index i = 0; i < samples.rows; ++i) {
    for (Eigen::Index j = 0; j < samples.columns; ++j) {
      require(std::isfinite(samples.data[i * samples.row_stride + j * samples.column_stride]),
              "moments: a sample is not finite");
    }
  }
  require(false, "moments: the samples are too large to be squared");
}

/// Each thread takes every threads-th leaf; the tree is the same for any number of them.
std::vector<SampleStatistics> leaves_of(const SampleView& samples, const Eigen::VectorXd& origin, int threads) {
  static const SimdLevel level = simd_levels().back();
  const Eigen::Index count = (samples.rows + kLeafRows - 1) / kLeafRows;
  std::vector<SampleStatistics> leaves(static_cast<std::size_t>(count));
  const auto work = [&](Eigen::Index first) {
    for (Eigen::Index i = first; i < count; i += threads) {
      SampleView leaf = samples;
      leaf.data += i * kLeafRows * samples.row_stride;
      leaf.rows = std::min(kLeafRows, samples.rows - i * kLeafRows);
      leaves[static_cast<std::size_t>(i)] = leaf_moments(leaf, origin, level);
    }
  };
  std::vector<std::future<void>> others;
  for (Eigen::Index i = 1; i < std::min<Eigen::Index>(threads, count); ++i) {
    others.push_back(std::async(std::launch::async, work, i));
  }
  work(0);
  for (auto& other : others) other.get();
  return leaves;
}

SampleStatistics moments_of(const SampleView& samples, double weight, int threads) {
  require(samples.rows >= 1 && samples.columns >= 1, "moments: no samples");
  require(std::isfinite(weight) && weight > 0.0, [&] { return "moments: weight " + std::to_string(weight); });
  require(threads >= 1, "moments: threads must be >= 1");
  Eigen::VectorXd origin(samples.columns);
  for (Eigen::Index j = 0; j < samples.columns; ++j) origin[j] = samples.data[j * samples.column_stride];
  SampleStatistics result = pooled(leaves_of(samples, origin, threads));
  result.mean += origin;
  require_finite(result, samples);
  result.count *= weight;
  return result;
}

}  // namespace

SampleStatistics moments(const Eigen::Ref<const Eigen::MatrixXd>& q, double weight, int threads) {
  return moments_of({q.data(), q.rows(), q.cols(), 1, q.outerStride()}, weight, threads);
}

SampleStatistics moments_of_rows(const Eigen::Ref<const RowMajorSamples>& q, double weight, int threads) {
  return moments_of({q.data(), q.rows(), q.cols(), q.outerStride(), 1}, weight, threads);
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
  PairwiseMerge tree;
  for (const SampleStatistics& part : parts) tree.add(part);
  return tree.result();
}

void PairwiseMerge::add(SampleStatistics part) {
  for (std::uint64_t count = added_++; (count & 1U) != 0; count >>= 1U) {
    part = merge(open_.back(), part);
    open_.pop_back();
  }
  open_.push_back(std::move(part));
}

SampleStatistics PairwiseMerge::result() const {
  SampleStatistics result;
  for (auto part = open_.rbegin(); part != open_.rend(); ++part) result = merge(*part, result);
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
