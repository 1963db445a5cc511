// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Which blocks of vertices can hold the nearest one: single precision, as wide as the processor allows. Decides only
// what is looked at in double precision, so its rounding, and hence the processor, does not show in the answer.
#pragma once

namespace opponens::motion::filter {

inline constexpr int kBlock = 16;     ///< vertices side by side
inline constexpr float kFar = 1e30F;  ///< beyond any squared distance that is looked at

/// Joints are looked at in groups: most blocks are settled by the first, so only the first is read whole.
inline constexpr int kGroup = 8;

/// Vertices in scaled single precision. Group g holds joints [g kGroup, min((g + 1) kGroup, dimension)) of all blocks:
/// [blocks x joints of the group x kBlock]. Unused places of the last block are far away.
struct Blocks {
  const float* const* groups = nullptr;
  int count = 0;
  int dimension = 0;
};

/// How far a squared distance may lie above the least one found and still be the nearest vertex's:
/// bound(least) = (sqrt(least) relative + absolute)^2.
struct Slack {
  float relative;  ///< >= 1
  float absolute;  ///< >= 0
};

/// least: [blocks] out, the least squared distance to target [dimension] of each block; kFar where no vertex is within
/// the bound of those before. Returns the bound of the least of all.
float block_minima_portable(const Blocks& blocks, const float* target, const Slack& slack, float* least);
float block_minima_avx2(const Blocks& blocks, const float* target, const Slack& slack, float* least);

}  // namespace opponens::motion::filter
