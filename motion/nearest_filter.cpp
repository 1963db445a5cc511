// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/nearest_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "motion/block_minima.hpp"

namespace opponens::motion {
namespace {

constexpr float kUnusedPlace = 1e15F;    // its square is kFar
constexpr double kLargestScaled = 1e12;  // beyond it, squares come near kFar: nothing is left out

int joints_of_group(int dimension, std::size_t group) {
  return std::min(filter::kGroup, dimension - static_cast<int>(group) * filter::kGroup);
}

float block_minima(const filter::Blocks& blocks, const float* target, const filter::Slack& slack, float* least) {
#ifdef OPPONENS_AVX2
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return filter::block_minima_avx2(blocks, target, slack, least);
#endif
  return filter::block_minima_portable(blocks, target, slack, least);
}

}  // namespace

static_assert(NearestFilter::kBlock == filter::kBlock);

NearestFilter::NearestFilter(const Eigen::VectorXd& weights)
    : dimension_(static_cast<int>(weights.size())),
      groups_(static_cast<std::size_t>((dimension_ + filter::kGroup - 1) / filter::kGroup)) {
  for (const double w : weights) scale_.push_back(std::sqrt(w));
}

void NearestFilter::add(const double* q) {
  const int place = size_ % kBlock;
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    const int joints = joints_of_group(dimension_, group);
    std::vector<float>& places = groups_[group];
    if (place == 0) places.resize(places.size() + static_cast<std::size_t>(joints * kBlock), kUnusedPlace);
    float* const block = places.data() + places.size() - joints * kBlock;
    for (int j = 0; j < joints; ++j) {
      const std::size_t joint = group * filter::kGroup + static_cast<std::size_t>(j);
      const double scaled = scale_[joint] * q[joint];
      largest_ = std::max(largest_, std::abs(scaled));
      block[j * kBlock + place] = static_cast<float>(scaled);
    }
  }
  ++size_;
}

void NearestFilter::clear() {
  size_ = 0;
  largest_ = 0.0;
  for (auto& group : groups_) group.clear();
}

std::vector<int> NearestFilter::candidates(const double* q) const {
  const int blocks = (size_ + kBlock - 1) / kBlock;
  std::vector<int> result;
  std::vector<float> target(scale_.size());
  double largest = largest_;
  for (std::size_t j = 0; j < scale_.size(); ++j) {
    largest = std::max(largest, std::abs(scale_[j] * q[j]));
    target[j] = static_cast<float>(scale_[j] * q[j]);
  }
  if (!(largest < kLargestScaled)) {
    result.resize(static_cast<std::size_t>(blocks));
    std::iota(result.begin(), result.end(), 0);
    return result;
  }
  constexpr double kUnit = 0x1p-24;
  const filter::Slack slack{static_cast<float>(1.0 + 4.0 * (dimension_ + 8) * kUnit),
                            static_cast<float>(8.0 * std::sqrt(dimension_) * kUnit * largest)};
  std::vector<const float*> groups;
  for (const auto& group : groups_) groups.push_back(group.data());
  std::vector<float> least(static_cast<std::size_t>(blocks));
  const float bound = block_minima({groups.data(), blocks, dimension_}, target.data(), slack, least.data());
  for (int i = 0; i < blocks; ++i) {
    if (least[static_cast<std::size_t>(i)] <= bound) result.push_back(i);
  }
  return result;
}

}  // namespace opponens::motion
