// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace opponens::verify {

/// What a re-check found. ok is true exactly when reasons is empty.
struct Verdict {
  bool ok = true;
  std::vector<std::string> reasons;                                  ///< one sentence each, with the values
  double worst_clearance = std::numeric_limits<double>::infinity();  ///< m, paths: least distance found; 0: collision
  std::pair<std::string, std::string> worst_pair;                    ///< paths: the bodies at that distance
  double worst_contact_penetration = 0.0;  ///< m, paths: deepest contact on the closing segment
  std::int64_t checked = 0;                ///< paths: configurations evaluated; grasps: wrenches

  void fail(std::string reason) {
    ok = false;
    reasons.push_back(std::move(reason));
  }
};

/// A value as a reason states it: six digits.
std::string number(double value);

}  // namespace opponens::verify
