// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/search_counts.hpp"

#include <utility>

namespace opponens::motion {

void BlockedRecord::add(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to, double fraction) {
  if (seen_++ % stride_ != 0) return;
  if (kept_.size() == kMost) {
    for (std::size_t i = 0; 2 * i < kMost; ++i) kept_[i] = std::move(kept_[2 * i]);
    kept_.resize(kMost / 2);
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  kept_.emplace_back(fraction == 1.0 ? q_to : Eigen::VectorXd(q_from + fraction * (q_to - q_from)));
}

}  // namespace opponens::motion
