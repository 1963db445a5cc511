// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/joint_groups.hpp"

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "motion/joint_metric.hpp"

namespace opponens::motion {
namespace {

bool is_length(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

GroupLimit limit_of(const PlanningGroup& group, double limit) { return {group.first, group.count, limit}; }

void validate(const std::vector<GroupLimit>& limits, Eigen::Index dimension, const std::string& what) {
  for (const GroupLimit& group : limits) {
    require(group.first >= 0 && group.count > 0 && group.first + group.count <= dimension, [&] {
      return what + ": joints " + std::to_string(group.first) + " to " + std::to_string(group.first + group.count - 1) +
             " are no group of " + std::to_string(dimension) + " joints";
    });
    require(is_length(group.limit),
            [&] { return what + " = " + std::to_string(group.limit) + ": must be positive and finite (rad)"; });
  }
}

double largest_share(const Eigen::Ref<const Eigen::VectorXd>& weights, const Eigen::Ref<const Eigen::VectorXd>& a,
                     const Eigen::Ref<const Eigen::VectorXd>& b, const std::vector<GroupLimit>& limits) {
  double share = 0.0;
  for (const GroupLimit& group : limits) {
    const auto part = [&](const auto& q) { return q.segment(group.first, group.count); };
    share = std::max(share, distance(part(weights), part(a), part(b)) / group.limit);
  }
  return share;
}

Spacing Spacing::divided_by(double share) const {
  Spacing result(all / share, groups);
  for (GroupLimit& group : result.groups) group.limit /= share;
  return result;
}

void validate(const Spacing& spacing, const std::string& who) {
  const bool groups = std::all_of(spacing.groups.begin(), spacing.groups.end(),
                                  [](const GroupLimit& group) { return is_length(group.limit); });
  require(is_length(spacing.all) && groups, [&] { return who + ": resolution must be positive and finite"; });
}

double spacings(const Spacing& spacing, const Eigen::Ref<const Eigen::VectorXd>& weights,
                const Eigen::Ref<const Eigen::VectorXd>& a, const Eigen::Ref<const Eigen::VectorXd>& b) {
  return std::max(distance(weights, a, b) / spacing.all, largest_share(weights, a, b, spacing.groups));
}

}  // namespace opponens::motion
