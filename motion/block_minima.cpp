// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/block_minima.hpp"

#include "motion/block_minima_kernel.hpp"

namespace opponens::motion::filter {

float block_minima_portable(const Blocks& blocks, const float* target, const Slack& slack, float* least) {
  return block_minima(blocks, target, slack, least);
}

}  // namespace opponens::motion::filter
