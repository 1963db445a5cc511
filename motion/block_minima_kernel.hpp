// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Included by one .cpp for each instruction set. Everything here has internal linkage, so that no code made for one
// processor can be linked into a path for another.
#pragma once

#include "motion/block_minima.hpp"

namespace opponens::motion::filter {
namespace {

#ifdef __AVX__
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
constexpr int kParts = kBlock / kLanes;
typedef float V __attribute__((vector_size(4 * kLanes)));
typedef float Loose __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

struct Sums {
  V part[kParts];
};

/// Adds the squared differences of some joints, of which the block holds one after the other.
[[gnu::always_inline]] inline void add(Sums& sums, const float* block, const float* target, int joints) {
  for (int j = 0; j < joints; ++j) {
    for (int part = 0; part < kParts; ++part) {
      const V difference = *reinterpret_cast<const Loose*>(block + j * kBlock + part * kLanes) - target[j];
      sums.part[part] += difference * difference;
    }
  }
}

[[gnu::always_inline]] inline V least_of(const Sums& sums) {
  V least = sums.part[0];
  for (int part = 1; part < kParts; ++part) least = sums.part[part] < least ? sums.part[part] : least;
  return least;
}

[[gnu::always_inline]] inline float least_lane(const V& lanes) {
  float least = lanes[0];
  for (int lane = 1; lane < kLanes; ++lane) least = lanes[lane] < least ? lanes[lane] : least;
  return least;
}

[[gnu::always_inline]] inline bool any_within(const V& lanes, float bound) {
  const auto within = lanes <= bound;
#if defined(__AVX__)
  return __builtin_ia32_movmskps256(__builtin_bit_cast(V, within)) != 0;
#elif defined(__SSE__)
  return __builtin_ia32_movmskps(__builtin_bit_cast(V, within)) != 0;
#else
  bool any = false;
  for (int lane = 0; lane < kLanes; ++lane) any = any || within[lane] != 0;
  return any;
#endif
}

[[gnu::always_inline]] inline float bound_of(float least, const Slack& slack) {
  const float root = __builtin_sqrtf(least) * slack.relative + slack.absolute;
  return root * root;
}

/// A block none of whose vertices is within the bound after some of the joints is left.
[[gnu::always_inline]] inline float block_minima(const Blocks& blocks, const float* target, const Slack& slack,
                                                 float* least) {
  const int first = blocks.dimension < kGroup ? blocks.dimension : kGroup;
  float bound = kFar;
  for (int i = 0; i < blocks.count; ++i) {
    Sums sums{};
    if (first == kGroup) {
      add(sums, blocks.groups[0] + i * kGroup * kBlock, target, kGroup);  // a constant: unrolled
    } else {
      add(sums, blocks.groups[0] + i * first * kBlock, target, first);
    }
    V lanes = least_of(sums);
    int done = first;
    for (; done < blocks.dimension && any_within(lanes, bound); done += kGroup) {
      const int joints = blocks.dimension - done < kGroup ? blocks.dimension - done : kGroup;
      add(sums, blocks.groups[done / kGroup] + i * joints * kBlock, target + done, joints);
      lanes = least_of(sums);
    }
    least[i] = kFar;
    if (done < blocks.dimension || !any_within(lanes, bound)) continue;
    least[i] = least_lane(lanes);
    const float here = bound_of(least[i], slack);
    bound = here < bound ? here : bound;
  }
  return bound;
}

}  // namespace
}  // namespace opponens::motion::filter
