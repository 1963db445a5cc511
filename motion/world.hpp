// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace opponens::motion {

/// An invalid configuration on the straight motion from q_from (exclusive, known valid) to q_to (inclusive), as a
/// fraction in (0, 1]: the first one found in the checker's own order, which need not be the nearest to q_from; nullopt
/// when the whole motion is valid. Adds the configurations evaluated to checks. Same arguments, same answer.
using MotionCheck = std::function<std::optional<double>(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                                                        std::int64_t& checks)>;

/// The only two questions a planner asks the world; a faster checker can be put under them. Valid means free of
/// collision and inside the joint limits.
struct World {
  MotionCheck first_invalid;
  /// Whether each row of a batch [B x d] is valid. Adds B to checks.
  std::function<std::vector<bool>(const Eigen::MatrixXd& batch, std::int64_t& checks)> free;
  /// first_invalid asked again, more strictly (denser, or continuous), of the motions of an answer before it is
  /// returned. Empty: an answer is not asked again.
  MotionCheck confirm;
  /// Names of the pairs that collide at q [d]; none when it is invalid for another reason. Asked after a search, of a
  /// bounded number of configurations, to say why it failed; never during it. Empty: a failure names no pairs.
  std::function<std::vector<std::pair<std::string, std::string>>(const Eigen::VectorXd& q)> explain;
};

/// Whether a motion is valid by both: asked as the planner asks, and confirmed as an answer is. Adds to checks.
inline bool valid_motion(const World& world, const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to,
                         std::int64_t& checks) {
  return !world.first_invalid(q_from, q_to, checks) && !(world.confirm && world.confirm(q_from, q_to, checks));
}

}  // namespace opponens::motion
