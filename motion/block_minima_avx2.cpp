// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Compiled for processors with AVX2 and FMA; called only where there is one.
#include "motion/block_minima.hpp"

#include "motion/block_minima_kernel.hpp"

namespace opponens::motion::filter {

float block_minima_avx2(const Blocks& blocks, const float* target, const Slack& slack, float* least) {
  return block_minima(blocks, target, slack, least);
}

}  // namespace opponens::motion::filter
