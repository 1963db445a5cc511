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
  std::vector<std::string> reasons;  ///< one sentence each, with the values
  bool certified = false;            ///< grasps: a certificate of force closure is stored, and it holds
  // Of paths:
  double worst_clearance = std::numeric_limits<double>::infinity();   ///< m, least distance found; 0: collision
  double proven_clearance = std::numeric_limits<double>::infinity();  ///< m, nothing comes nearer anywhere on the path
  std::pair<std::string, std::string> worst_pair;                     ///< the bodies at the worst clearance
  std::string worst_place;                                            ///< where that is on the path
  double worst_contact_penetration = 0.0;   ///< m, deepest contact found on the closing segment
  double proven_contact_penetration = 0.0;  ///< m, no contact is deeper anywhere on it
  std::int64_t distances = 0;               ///< distances of two bodies asked for, beyond bounding volumes
  std::int64_t checked = 0;                 ///< paths: configurations evaluated; grasps: wrenches

  void fail(std::string reason) {
    ok = false;
    reasons.push_back(std::move(reason));
  }
};

/// A value as a reason states it: six digits.
std::string number(double value);

}  // namespace opponens::verify
